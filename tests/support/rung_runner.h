// Runs any rung of the ladder on a list of impacts, whether it takes one a call or many.
#pragma once

#include "carom/kernel/ladder.h"
#include "support/batch_arrays.h"

namespace carom::test {

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

inline const kernel::Rung& baseline_rung() {
    return kernel::ladder().front();
}

}  // namespace carom::test
