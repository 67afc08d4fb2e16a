// No error exceeds the tolerance: over random impacts, impacts built to be hard, and any approach speed. The
// nightly run has twenty times as many (tolerance_slow_test.cpp).
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "reference/solver.h"
#include "tolerance_bound.h"

namespace carom::test {
using reference::Generator;
using reference::Impact;
using reference::random_impact;
using reference::random_impacts;

namespace {

using namespace kernel;

TEST(ToleranceBound, RandomImpacts) {
    for (ClothSlip slip : {ClothSlip::kConsistent, ClothSlip::kAsPublished}) {
        std::vector<Impact> impacts = random_impacts(42, 2000);
        for (Impact& i : impacts) i.params.cloth_slip = slip;
        expect_bound(impacts, {1e-3, 1e-6, 1e-10});
    }
}

TEST(ToleranceBound, WithoutRestitution) {
    for (ClothSlip slip : {ClothSlip::kConsistent, ClothSlip::kAsPublished}) {
        std::vector<Impact> impacts = random_impacts(43, 700);
        for (Impact& i : impacts) {
            i.params.cloth_slip = slip;
            i.params.e_b = 0.0;
        }
        expect_bound(impacts, {1e-3, 1e-6, 1e-10});
        for (Impact& i : impacts) i.params.e_b = 1e-7;  // the work of restitution is rounding noise
        expect_bound(impacts, {1e-6, 1e-12});
    }
}

// Slow, fast, and almost purely sideways: the bound is relative to the approach speed until rounding shows.
TEST(ToleranceBound, AnyApproachSpeed) {
    Generator rng(44);
    std::vector<Impact> impacts;
    for (int n = 0; n < 700; ++n) {
        Impact i = random_impact(rng);
        const double scale = std::pow(10.0, rng.uniform(-12.0, 4.0));
        for (int k = 0; k < 3; ++k) {
            i.ball1.v[k] *= scale;
            i.ball1.w[k] *= scale;
            i.ball2.v[k] *= scale;
            i.ball2.w[k] *= scale;
        }
        impacts.push_back(i);
    }
    for (double share : {1e-4, 1e-6, 1e-9}) {  // approach speed over tangential speed
        for (int n = 0; n < 200; ++n) {
            Impact i{};
            i.params = {0.028575, 0.17, 0.2, 0.3, 0.06, 0.9, ClothSlip::kConsistent};
            i.ball2.r[1] = 2.0 * i.params.R;
            i.ball1.v[0] = rng.uniform(-1.0, 1.0);
            i.ball1.v[1] = share;
            for (int k = 0; k < 3; ++k) i.ball1.w[k] = rng.uniform(-30.0, 30.0);
            impacts.push_back(i);
        }
    }
    expect_bound(impacts, {1e-3, 1e-6, 1e-10});
}

TEST(ToleranceBound, ImpactsBuiltToBeHard) {
    Generator rng(45);
    std::vector<Impact> impacts;
    for (int n = 0; n < 1000; ++n)
        impacts.push_back(hard_random_impact(rng, 0.12, 0.4, ClothSlip::kConsistent));
    for (int n = 0; n < 1000; ++n)
        impacts.push_back(hard_random_impact(rng, 1.0, 1.0, ClothSlip::kConsistent));
    expect_bound(impacts, {1e-2, 1e-3, 1e-6, 1e-10, 1e-12});
    // As published, the cloth increases the slip; with friction near 1 the model itself becomes unstable.
    for (Impact& i : impacts) i = hard_random_impact(rng, 0.12, 0.4, ClothSlip::kAsPublished);
    expect_bound(impacts, {1e-2, 1e-3, 1e-6, 1e-10});
}

TEST(ToleranceBound, UnequalMasses) {
    for (ClothSlip slip : {ClothSlip::kConsistent, ClothSlip::kAsPublished}) {
        expect_bound(impacts_of_masses_that_differ(46, 1000, slip), {1e-2, 1e-3, 1e-6, 1e-10, 1e-12});
    }
}

}  // namespace
}  // namespace carom::test
