// Marches impacts both summed and as published, and compares the results by the bound of march.h.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "carom/kernel/march.h"
#include "tolerance_support.h"

namespace carom::test {

inline std::vector<Impact> random_impacts_of(std::uint64_t seed, int count, kernel::ClothSlip slip) {
    std::vector<Impact> impacts = reference::random_impacts(seed, count);
    for (Impact& impact : impacts) impact.params.cloth_slip = slip;
    return impacts;
}

inline std::vector<Impact> hard_impacts_of(std::uint64_t seed, int count, bool usual,
                                           kernel::ClothSlip slip) {
    Generator rng(seed);
    std::vector<Impact> impacts;
    for (int i = 0; i < count; ++i)
        impacts.push_back(hard_random_impact(rng, usual ? 0.12 : 1.0, usual ? 0.4 : 1.0, slip));
    return impacts;
}

/// Largest difference of a component of v or R w.
inline double apart(const kernel::ImpactResult& a, const kernel::ImpactResult& b, double R) {
    double most = 0.0;
    for (int k = 0; k < 3; ++k)
        most = std::max({most, std::fabs(a.v1[k] - b.v1[k]), std::fabs(a.v2[k] - b.v2[k]),
                         R * std::fabs(a.w1[k] - b.w1[k]), R * std::fabs(a.w2[k] - b.w2[k])});
    return most;
}

/// Numbers of impacts with the bits of the published march, and of summed ones.
struct Followed {
    int left_to_published = 0, summed = 0;
};

/// Expects status, steps and the bound of every impact.
inline Followed follow(const std::vector<Impact>& impacts, int n) {
    const kernel::Isa isa = kernel::best_isa();
    Followed followed;
    for (std::size_t i = 0; i < impacts.size(); ++i) {
        const Impact& in = impacts[i];
        kernel::ImpactResult want, got;
        kernel::march_function(isa)(in.ball1, in.ball2, in.params, n, want);
        kernel::summed_march_function(isa)(in.ball1, in.ball2, in.params, n, got);
        EXPECT_EQ(got.status, want.status) << "impact " << i;
        EXPECT_EQ(got.steps, want.steps) << "impact " << i;
        if (same_velocities(got, want)) {
            ++followed.left_to_published;
            continue;
        }
        ++followed.summed;
        EXPECT_LE(apart(got, want, in.params.R), kernel::kSummedDifference * approach_speed(in) +
                                                     kernel::kSummedRounding * n * speed_scale(in))
            << "impact " << i << ", N = " << n;
    }
    return followed;
}

}  // namespace carom::test
