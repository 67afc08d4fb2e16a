// Runs any variant of the ladder on a list of impacts, whether it accepts one per call or many.
#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <string>
#include <vector>

#include "ladder/ladder.h"
#include "reference/batch_arrays.h"

namespace carom::test {
using reference::BatchArrays;
using reference::Impact;

inline std::vector<kernel::ImpactResult> run_variant(const kernel::Variant& variant,
                                                     std::vector<Impact> impacts, int n,
                                                     kernel::ClothSlip slip) {
    std::vector<kernel::ImpactResult> results(impacts.size());
    for (Impact& impact : impacts) impact.params.cloth_slip = slip;
    if (variant.batch == nullptr) {
        for (std::size_t i = 0; i < impacts.size(); ++i)
            variant.march(impacts[i].ball1, impacts[i].ball2, impacts[i].params, n, results[i]);
        return results;
    }
    BatchArrays arrays(impacts, slip);
    variant.batch(arrays.batch, n, arrays.result);
    for (std::size_t i = 0; i < impacts.size(); ++i) results[i] = arrays.get(i);
    return results;
}

/// The rows of the ladder that a test covers.
template <class Wanted>
std::vector<kernel::Variant> variants_where(const Wanted& wanted) {
    std::vector<kernel::Variant> variants;
    for (const kernel::Variant& variant : kernel::ladder())
        if (wanted(variant)) variants.push_back(variant);
    return variants;
}

/// The name of a test of one variant on one instruction set.
inline std::string variant_name(const testing::TestParamInfo<kernel::Variant>& variant) {
    std::string text = std::string(variant.param.name) + "_" + name(variant.param.isa);
    for (char& c : text)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return text;
}

inline const kernel::Variant& baseline_variant() {
    return kernel::ladder().front();
}

}  // namespace carom::test
