// Checks single and batch results against the truth, lane by lane.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

#include "reference/solver.h"
#include "tolerance_support.h"

namespace carom::test {
using reference::error_of;
using reference::Impact;
using reference::ImpactTruth;
using reference::reference_impact;

/// Expects every error within the tolerance plus a few units of rounding of the largest speed. One sign of
/// the cloth slip per call. Batches need balls of one mass; others are solved one by one.
inline void expect_bound(const std::vector<Impact>& impacts, std::initializer_list<double> tolerances) {
    std::vector<ImpactTruth> truths;
    truths.reserve(impacts.size());
    // Order 16 and 1e-15 per step: ten times below the tightest tested bound, in half the time.
    for (const Impact& i : impacts) {
        truths.push_back(reference_impact(i.ball1, i.ball2, i.params, {16, 1e-15L, 1e-17L}));
    }
    Lanes lanes(impacts);
    bool equal = true;
    for (const Impact& i : impacts) equal = equal && i.params.mass_ratio == 1.0;
    for (double tolerance : tolerances) {
        kernel::tolerance_batch_function(kernel::best_isa())(lanes.batch(), tolerance, lanes.results());
        int failures = 0;
        double worst = 0.0, worst_in_batch = 0.0;
        for (std::size_t n = 0; n < impacts.size(); ++n) {
            const Impact& i = impacts[n];
            ASSERT_TRUE(truths[n].ok);
            const double R = i.params.R;
            const double bound = tolerance + 4e-15 * speed_scale(i) / static_cast<double>(truths[n].approach);
            const kernel::ImpactResult single = solve(i, tolerance);
            ASSERT_EQ(single.status, kernel::ImpactStatus::kOk);
            const double error = error_of(single, truths[n], R);
            const double in_batch = equal ? error_of(lanes.result(n), truths[n], R) : 0.0;
            worst = std::fmax(worst, error / bound);
            worst_in_batch = std::fmax(worst_in_batch, in_batch / bound);
            if (!(error <= bound && in_batch <= bound) && ++failures <= 5) {
                ADD_FAILURE() << "impact " << n << ": error " << error << ", in the batch " << in_batch
                              << ", asked " << tolerance << ", method " << name(single.method);
            }
        }
        EXPECT_EQ(failures, 0) << "of " << impacts.size() << " at " << tolerance;
        ::testing::Test::RecordProperty("share_of_bound", std::to_string(worst));
        ::testing::Test::RecordProperty("share_of_bound_in_batch", std::to_string(worst_in_batch));
    }
}

}  // namespace carom::test
