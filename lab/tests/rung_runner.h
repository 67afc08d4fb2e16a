// Runs any rung of the ladder on a list of impacts, whether it takes one per call or many.
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

inline std::vector<kernel::ImpactResult> run_rung(const kernel::Rung& rung, std::vector<Impact> impacts,
                                                  int n, kernel::ClothSlip slip) {
    std::vector<kernel::ImpactResult> results(impacts.size());
    for (Impact& impact : impacts) impact.params.cloth_slip = slip;
    if (rung.batch == nullptr) {
        for (std::size_t i = 0; i < impacts.size(); ++i)
            rung.march(impacts[i].ball1, impacts[i].ball2, impacts[i].params, n, results[i]);
        return results;
    }
    BatchArrays arrays(impacts, slip);
    rung.batch(arrays.batch, n, arrays.result);
    for (std::size_t i = 0; i < impacts.size(); ++i) results[i] = arrays.get(i);
    return results;
}

/// The rows of the ladder that a test covers.
template <class Wanted>
std::vector<kernel::Rung> rungs_where(const Wanted& wanted) {
    std::vector<kernel::Rung> rungs;
    for (const kernel::Rung& rung : kernel::ladder())
        if (wanted(rung)) rungs.push_back(rung);
    return rungs;
}

/// The name of a test of one rung on one instruction set.
inline std::string rung_name(const testing::TestParamInfo<kernel::Rung>& rung) {
    std::string text = std::string(rung.param.name) + "_" + name(rung.param.isa);
    for (char& c : text)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return text;
}

inline const kernel::Rung& baseline_rung() {
    return kernel::ladder().front();
}

}  // namespace carom::test
