// Checks the reference solution itself: by other orders and step sizes, by its energy balance, by closed
// solutions and by the march.
#include "reference/solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carom/kernel/march.h"
#include "tolerance_support.h"

namespace carom::test {
using reference::error_of;
using reference::Generator;
using reference::Impact;
using reference::ImpactTruth;
using reference::random_impact;
using reference::random_impacts;
using reference::reference_impact;
using reference::TruthSettings;

namespace {

using namespace kernel;

double distance(const ImpactTruth& a, const ImpactTruth& b, double R) {
    long double worst = 0;
    for (int k = 0; k < 3; ++k) {
        worst = std::max({worst, std::fabs(a.v1[k] - b.v1[k]), std::fabs(a.v2[k] - b.v2[k]),
                          R * std::fabs(a.w1[k] - b.w1[k]), R * std::fabs(a.w2[k] - b.w2[k])});
    }
    return static_cast<double>(worst / a.approach);
}

ImpactTruth truth(const Impact& i, const TruthSettings& settings = {}) {
    const ImpactTruth t = reference_impact(i.ball1, i.ball2, i.params, settings);
    EXPECT_TRUE(t.ok);
    return t;
}

TEST(ReferenceImpact, OrderAndStepSizeDoNotMatter) {
    Generator rng(11);
    for (ClothSlip slip : {ClothSlip::kConsistent, ClothSlip::kAsPublished}) {
        for (int n = 0; n < 300; ++n) {
            Impact i = n % 2 == 0 ? random_impact(rng) : hard_random_impact(rng, 0.12, 0.4, slip);
            i.params.cloth_slip = slip;
            const ImpactTruth fine = truth(i);
            // Extended precision rounds at 5e-20 of the input speeds.
            const double rounding = 1e-17 * speed_scale(i) / approach_speed(i);
            EXPECT_LT(distance(fine, truth(i, {12, 1e-17L, 1e-19L}), i.params.R), 1e-14 + rounding);
            EXPECT_LT(distance(fine, truth(i, {22, 1e-19L, 1e-18L}), i.params.R), 1e-14 + rounding);
        }
    }
}

// T14: the balls lose the energy dissipated by both frictions and the restitution.
TEST(ReferenceImpact, EnergyBookCloses) {
    Generator rng(12);
    for (int n = 0; n < 400; ++n) {
        const Impact i =
            n % 2 == 0 ? random_impact(rng) : hard_random_impact(rng, 1.0, 1.0, ClothSlip::kConsistent);
        const ImpactTruth t = truth(i);
        long double before = 0, after = 0;
        const long double R2 = static_cast<long double>(i.params.R) * i.params.R;
        const auto square = [](long double x) { return x * x; };
        for (int k = 0; k < 3; ++k) {
            before += square(i.ball1.v[k]) + square(i.ball2.v[k]);
            before += 0.4L * R2 * (square(i.ball1.w[k]) + square(i.ball2.w[k]));
            after += square(t.v1[k]) + square(t.v2[k]) + 0.4L * R2 * (square(t.w1[k]) + square(t.w2[k]));
        }
        const long double e = i.params.e_b;
        const long double loss = (1 - e * e) * t.compression_work + t.friction_loss;
        EXPECT_NEAR(static_cast<double>((before - after) / 2 - loss), 0.0,
                    1e-15 * static_cast<double>(square(t.approach)) + 1e-17 * static_cast<double>(before));
        EXPECT_GE(t.friction_loss, 0.0L);
    }
}

TEST(ReferenceImpact, HorizontalSlipSticksAsInClosedForm) {
    Impact i{};
    i.params = {0.03125, 0.17, 0.2, 0.2, 0.05, 0.9, ClothSlip::kConsistent};
    i.ball2.r[1] = 2.0 * i.params.R;
    i.ball1.v[1] = 1.0;
    for (double x : {0.3, 0.5, -0.1, 0.332, 0.333, 2.0}) {
        i.ball1.v[0] = x;
        const ImpactTruth t = truth(i);
        const double most = 0.05 * 0.95, stop = std::fabs(x) / 7.0;
        const double impulse = std::copysign(std::fmin(most, stop), x);
        EXPECT_NEAR(static_cast<double>(t.v2[0]), impulse, 2e-16);
        EXPECT_NEAR(static_cast<double>(t.v1[0]), x - impulse, 2e-16);
        EXPECT_NEAR(static_cast<double>(t.v2[1]), 0.95, 2e-16);
        EXPECT_EQ(t.stuck, stop < most);
    }
}

// T16: without cloth friction |x|^5 is proportional to z^7 while the slip lasts.
TEST(ReferenceImpact, DirectionInTheSlipPlane) {
    Impact i{};
    i.params = {0.03125, 0.17, 0.0, 0.0, 0.05, 0.95, ClothSlip::kConsistent};
    i.ball2.r[1] = 2.0 * i.params.R;
    i.ball1.v[0] = 0.5;
    i.ball1.v[1] = 1.0;
    i.ball1.w[0] = 0.7 / i.params.R;
    const ImpactTruth t = truth(i);
    const long double R = i.params.R;
    const long double x = t.v1[0] - t.v2[0] - R * (t.w1[2] + t.w2[2]), z = R * (t.w1[0] + t.w2[0]);
    EXPECT_NEAR(static_cast<double>(x), 0.310036368, 1e-9);
    EXPECT_NEAR(static_cast<double>(z), 0.497556930, 1e-9);
    EXPECT_NEAR(static_cast<double>(5 * std::log(x / 0.5L) - 7 * std::log(z / 0.7L)), 0.0, 1e-15);
}

TEST(ReferenceImpact, MarchConvergesToIt) {
    const MarchFunction march = march_function(best_isa());
    for (ClothSlip slip : {ClothSlip::kConsistent, ClothSlip::kAsPublished}) {
        for (Impact i : random_impacts(3, 40)) {
            i.params.cloth_slip = slip;
            const ImpactTruth t = truth(i);
            for (int n : {1000, 10000}) {
                ImpactResult r;
                march(i.ball1, i.ball2, i.params, n, r);
                EXPECT_LT(error_of(r, t, i.params.R), 2.0 / n);
            }
        }
    }
}

TEST(ReferenceImpact, NoImpactWithoutApproach) {
    Impact i{};
    i.params = {0.03, 0.2, 0.2, 0.2, 0.05, 0.95, ClothSlip::kConsistent};
    i.ball2.r[1] = 0.06;
    EXPECT_FALSE(reference_impact(i.ball1, i.ball2, i.params).ok);
    i.ball1.v[1] = -1.0;
    EXPECT_FALSE(reference_impact(i.ball1, i.ball2, i.params).ok);
}

}  // namespace
}  // namespace carom::test
