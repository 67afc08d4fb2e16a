// The tolerance kernel against closed solutions, published tables and its own contract.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "carom/kernel/closed_forms.h"
#include "reference/solver.h"
#include "tolerance_support.h"

namespace carom::test {
using reference::error_of;
using reference::Generator;
using reference::Impact;
using reference::ImpactTruth;
using reference::kDegree;
using reference::random_impact;
using reference::random_impacts;
using reference::reference_impact;

namespace {

using namespace kernel;

constexpr double kRadius = 0.03125;  // a power of two, so that spins and slips are exact

// Ball 1 at the origin with velocity (x, 1), ball 2 at rest at (0, 2R): y is the line of centres.
Impact plain(double x, double mu_b = 0.05, double e_b = 0.95) {
    Impact i{};
    i.params = {kRadius, 0.17, 0.2, 0.2, mu_b, e_b, ClothSlip::kConsistent};
    i.ball2.r[1] = 2.0 * kRadius;
    i.ball1.v[0] = x;
    i.ball1.v[1] = 1.0;
    return i;
}

TEST(Tolerance, WithoutBallFrictionTheExchangeIsExact) {
    for (double e : {0.0, 0.5, 0.95, 1.0}) {
        const ImpactResult r = solve(plain(0.3, 0.0, e), 1e-6);
        EXPECT_EQ(r.status, ImpactStatus::kOk);
        EXPECT_EQ(r.method, ToleranceMethod::kClosedFrictionless);
        EXPECT_EQ(r.steps, 1);
        EXPECT_EQ(r.v2[1], 0.5 * (1.0 + e));
        EXPECT_EQ(r.v1[1], 1.0 - 0.5 * (1.0 + e));
        EXPECT_EQ(r.v1[0], 0.3);
        EXPECT_EQ(r.w1[2], 0.0);
    }
}

// T6, and T12: no slip, no friction.
TEST(Tolerance, GearingThrowsNothing) {
    Impact i = plain(0.5);
    i.ball1.w[2] = 0.5 / kRadius;
    for (double tolerance : {1e-3, 1e-10}) {
        const ImpactResult r = solve(i, tolerance);
        EXPECT_EQ(r.method, ToleranceMethod::kClosedGearing);
        EXPECT_EQ(r.v2[0], 0.0);
        EXPECT_EQ(r.w2[2], 0.0);
        EXPECT_EQ(r.w1[2], i.ball1.w[2]);
        EXPECT_EQ(r.v2[1], 0.975);
    }
}

// H25 and the no-slip branch of the throw table: dv = slip/7 if it sticks, mu_b times the impulse if it keeps
// sliding.
TEST(Tolerance, HorizontalSlipIsClosed) {
    for (double x : {1e-4, 0.1, 0.33, -0.2, 0.4, 3.0}) {
        const ImpactResult r = solve(plain(x), 1e-3);
        EXPECT_EQ(r.method, ToleranceMethod::kClosedStick);
        const double thrown = std::fmin(std::fabs(x) / 7.0, 0.05 * 0.975);
        EXPECT_NEAR(r.v2[0], std::copysign(thrown, x), 1e-16);
        EXPECT_NEAR(r.w1[2], std::copysign(2.5 * thrown / kRadius, x), 1e-13);
        EXPECT_EQ(r.w1[2], r.w2[2]);
    }
    for (const auto& [cut, throw_deg] : {std::pair{10.0, 1.44295}, {20.0, 2.97646}, {30.0, 4.71500}}) {
        Impact i = plain(std::sin(cut * kDegree), 1.0, 1.0);  // T11
        i.ball1.v[1] = std::cos(cut * kDegree);
        const ImpactResult r = solve(i, 1e-6);
        EXPECT_NEAR(std::atan2(r.v2[0], r.v2[1]) / kDegree, throw_deg, 1e-5);
    }
}

// The straight draw shot, on which no march converges: against the spin, the cue ball's slip is vertical
// only.
TEST(Tolerance, StraightDraw) {
    for (double spin : {30.0, 60.0, -40.0}) {
        Impact i = plain(0.0);
        i.ball1.w[0] = spin;
        const ImpactTruth t = reference_impact(i.ball1, i.ball2, i.params);
        for (double tolerance : {1e-3, 1e-6, 1e-10, 1e-12}) {
            const ImpactResult r = solve(i, tolerance);
            EXPECT_LT(error_of(r, t, kRadius), tolerance) << spin;
            EXPECT_EQ(r.v1[0], 0.0);
            EXPECT_EQ(r.v2[0], 0.0);
        }
    }
    // A slip of 0.01 ends during the impact: each ball receives a fifth of it, less the cloth's share.
    Impact i = plain(0.0);
    i.params.mu_s1 = i.params.mu_s2 = 0.0;
    i.ball1.w[0] = 0.01 / kRadius;
    const ImpactResult r = solve(i, 1e-10);
    EXPECT_NEAR(r.w1[0] * kRadius, 0.005, 1e-12);
    EXPECT_NEAR(r.w2[0] * kRadius, -0.005, 1e-12);
}

// Table 7c: Mathavan et al. 2014, speeds and angles after both balls roll.
TEST(Tolerance, MathavanTable) {
    struct Row {
        double v0, w, cut, v_cue, v_object, angle_cue, angle_object;
    };
    const Row rows[] = {{1.539, 58.63, 33.83, .9141, .8305, 31.942, 32.226},
                        {1.032, 39.31, 26.36, .5200, .5989, 32.470, 25.088},
                        {1.364, 51.96, 40.52, .9169, .6759, 29.926, 38.639},
                        {1.731, 65.94, 46.50, 1.2775, .7794, 27.326, 44.393},
                        {.942, 35.89, 18.05, .3836, .5786, 29.481, 17.168}};
    for (const Row& row : rows) {
        Impact i{};
        i.params = {0.02625, 0.1406, 0.21, 0.21, 0.05, 0.89, ClothSlip::kConsistent};
        const double R = i.params.R, phi = row.cut * kDegree;
        i.ball2.r[0] = 2.0 * R * std::sin(phi);
        i.ball2.r[1] = 2.0 * R * std::cos(phi);
        i.ball1.v[1] = row.v0;
        i.ball1.w[0] = -row.w;
        for (double tolerance : {1e-3, 1e-6, 1e-10}) {
            const ImpactResult r = solve(i, tolerance);
            const auto rolled = [R](const double(&v)[3], const double(&w)[3], double& speed, double& angle) {
                const double x = 5.0 / 7.0 * v[0] + 2.0 / 7.0 * R * w[1];
                const double y = 5.0 / 7.0 * v[1] - 2.0 / 7.0 * R * w[0];
                speed = std::hypot(x, y);
                angle = std::fabs(std::atan2(x, y)) / kDegree;
            };
            double cue, object, cue_angle, object_angle;
            rolled(r.v1, r.w1, cue, cue_angle);
            rolled(r.v2, r.w2, object, object_angle);
            const double share = tolerance > 1e-4 ? 0.003 : 2e-4;  // printed digits of the converged column
            EXPECT_NEAR(cue, row.v_cue, share * row.v_cue);
            EXPECT_NEAR(object, row.v_object, share * row.v_object);
            EXPECT_NEAR(cue_angle, row.angle_cue, share * row.angle_cue);
            EXPECT_NEAR(object_angle, row.angle_object, share * row.angle_object);
        }
    }
}

// T14 at the strictest tolerance: the lost energy equals the dissipation of restitution and both frictions.
TEST(Tolerance, EnergyBook) {
    Generator rng(21);
    for (int n = 0; n < 300; ++n) {
        const Impact i =
            n % 2 == 0 ? random_impact(rng) : hard_random_impact(rng, 0.2, 0.5, ClothSlip::kConsistent);
        const ImpactTruth t = reference_impact(i.ball1, i.ball2, i.params);
        const ImpactResult r = solve(i, kTightestTolerance);
        const double e = i.params.e_b;
        const double loss = static_cast<double>((1 - e * e) * t.compression_work + t.friction_loss);
        EXPECT_LE(std::fabs(energy_before(i) - energy_after(i, r) - loss), 1e-12 * energy_before(i));
    }
}

TEST(Tolerance, ParametersOutOfRangeReturnTheInput) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const Impact good = plain(0.4);
    const auto refused = [](const Impact& i, double tolerance) {
        const ImpactResult r = solve(i, tolerance);
        return r.status == ImpactStatus::kBadParameter && r.v1[0] == i.ball1.v[0] &&
               r.v1[1] == i.ball1.v[1] && r.v2[1] == 0.0 && r.steps == 0 &&
               r.method == ToleranceMethod::kNone;
    };
    for (double tolerance : {0.0, -1e-6, 9e-14, 0.11, 1.0, nan, std::numeric_limits<double>::infinity()})
        EXPECT_TRUE(refused(good, tolerance)) << tolerance;
    for (double tolerance : {kTightestTolerance, kLoosestTolerance})
        EXPECT_EQ(solve(good, tolerance).status, ImpactStatus::kOk);
    for (double mu : {1.0000001, 2.0, 1e300, nan, -0.1}) {
        Impact i = good;
        i.params.mu_b = mu;
        EXPECT_TRUE(refused(i, 1e-6)) << mu;
        i = good;
        i.params.mu_s2 = mu;
        EXPECT_TRUE(refused(i, 1e-6)) << mu;
    }
}

TEST(Tolerance, LooserTolerancesNeverNeedMoreSweeps) {
    for (const Impact& i : random_impacts(4, 500)) {
        const ImpactResult loose = solve(i, 1e-2), tight = solve(i, 1e-11);
        EXPECT_LE(loose.steps, tight.steps);
        EXPECT_LE(loose.method, tight.method);
        EXPECT_GE(loose.steps, 1);
    }
}

TEST(Tolerance, MethodsAndInstructionSetsHaveNames) {
    std::set<std::string> names;
    for (ToleranceMethod method : {ToleranceMethod::kClosedFrictionless, ToleranceMethod::kClosedGearing,
                                   ToleranceMethod::kClosedStick, ToleranceMethod::kCollocation4,
                                   ToleranceMethod::kCollocation8, ToleranceMethod::kAdaptive}) {
        names.insert(name(method));
    }
    EXPECT_EQ(names.size(), 6u);
    EXPECT_EQ(names.count(""), 0u);
    EXPECT_STREQ(name(ToleranceMethod::kNone), "");
}

// On the benchmark's impacts, each method is used at the tolerance it was designed for.
TEST(Tolerance, EasyImpactsNeedOneCollocation) {
    const auto impacts = random_impacts(5, 2000);
    const auto count = [&](double tolerance, ToleranceMethod method) {
        int n = 0;
        for (const Impact& i : impacts) n += solve(i, tolerance).method == method;
        return n;
    };
    EXPECT_GT(count(1e-3, ToleranceMethod::kCollocation4), 1800);
    EXPECT_GT(count(1e-6, ToleranceMethod::kCollocation4), 1500);
    EXPECT_GT(count(1e-10, ToleranceMethod::kCollocation8), 500);
    EXPECT_LT(count(1e-6, ToleranceMethod::kAdaptive), 200);
    EXPECT_GT(count(1e-6, ToleranceMethod::kAdaptive), 20);
}

// Sweeps with 4 nodes come before those with 8 and halve their work: without them, 8 nodes need 6.2 of the
// expensive sweeps here.
TEST(Tolerance, SweepsOfEightNodes) {
    const std::vector<Impact> impacts = reference::random_impacts(1, 2000);
    Lanes lanes(impacts);
    kernel::tolerance_batch_function(kernel::best_isa())(lanes.batch(), 1e-10, lanes.results());
    double single = 0.0, in_batch = 0.0, count = 0.0;
    for (std::size_t n = 0; n < impacts.size(); ++n) {
        const ImpactResult r = solve(impacts[n], 1e-10), b = lanes.result(n);
        if (r.method != ToleranceMethod::kCollocation8 || b.method != r.method) continue;
        single += static_cast<double>(r.steps);
        in_batch += static_cast<double>(b.steps);
        ++count;
    }
    EXPECT_GT(count, 700.0);
    EXPECT_LT(single, 5.8 * count);
    EXPECT_LT(in_batch, 5.8 * count);
}

}  // namespace
}  // namespace carom::test
