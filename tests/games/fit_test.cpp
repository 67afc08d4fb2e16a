// Fits of synthetic tracks with known numbers.
#include "carom/games/fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/draws.h"
#include "carom/engine/plan.h"
#include "carom/engine/scene_number.h"
#include "carom/engine/simulate.h"
#include "carom/kernel/splitmix64.h"
#include "support/scenes.h"

namespace carom::games {
namespace {

const std::vector<std::string> kVary{"balls.mu_s",      "balls.mu_r", "balls.e_c_fit.0",
                                     "balls.f_c_fit.0", "cue.speed",  "cue.aim_deg"};

Scene three_cushion() {
    return test::shipped("three_cushion");
}

/// Places of the balls 60 times a second, with normal errors.
std::vector<TrackPoint> tracks_of(const Scene& scene, double until, double noise, std::uint64_t seed) {
    const Record record = simulate(make_plan(scene, kernel::Isa::kScalar));
    SplitMix64 rng(seed);
    std::vector<TrackPoint> points;
    for (int k = 0; k < until * 60.0; ++k)
        for (int ball = 0; ball < static_cast<int>(record.tracks.size()); ++ball) {
            const double t = k / 60.0;
            const Vec2 error(standard_normal(rng), standard_normal(rng));
            points.push_back({t, ball, planar(record.state_at(ball, t).position) + noise * error});
        }
    return points;
}

Scene started(double off) {
    Scene scene = three_cushion();
    const double factors[] = {1.01, 0.97, 0.995, 1.02, 1.003, 1.0};
    for (std::size_t k = 0; k < kVary.size(); ++k) {
        const SceneNumber number(scene, kVary[k]);
        number.put(scene, number.value(scene) * (1.0 + off * (factors[k] - 1.0)));
    }
    scene.cue->aim_deg += 0.02 * off;
    return scene;
}

TEST(Fit, RecoversTheNumbersOfExactTracks) {
    const Fit found =
        fit(started(1.0), tracks_of(three_cushion(), 6.5, 0.0, 1), {kVary}, kernel::Isa::kScalar);
    EXPECT_TRUE(found.converged) << found.message;
    EXPECT_LT(found.rms, 1e-7);
    EXPECT_LE(found.shots, 12);
    for (std::size_t k = 0; k < kVary.size(); ++k) {
        const double truth = SceneNumber(three_cushion(), kVary[k]).value(three_cushion());
        EXPECT_NEAR(found.values[k], truth, 1e-6 * std::abs(truth)) << kVary[k];
    }
    EXPECT_TRUE(found.warnings.empty()) << found.warnings[0];
}

// With 1 mm of noise, all numbers lie within three standard deviations of the truth in 95 of 100 trials, and
// their spread matches the deviations.
TEST(Fit, DeviationsMatchNoisyTracks) {
    const int trials = 100;
    int good = 0;
    double squares = 0.0;
    for (int trial = 0; trial < trials; ++trial) {
        const Fit found =
            fit(started(0.3), tracks_of(three_cushion(), 3.0, 1e-3, static_cast<std::uint64_t>(trial)),
                {kVary}, kernel::Isa::kScalar);
        bool within = found.converged;
        for (std::size_t k = 0; k < kVary.size(); ++k) {
            const double truth = SceneNumber(three_cushion(), kVary[k]).value(three_cushion());
            const double off = (found.values[k] - truth) / found.deviations()[k];
            within = within && std::abs(off) < 3.0;
            squares += off * off / (trials * static_cast<double>(kVary.size()));
        }
        good += within ? 1 : 0;
        EXPECT_NEAR(found.noise, 1e-3, 2e-4);
    }
    EXPECT_GE(good, 95);
    EXPECT_NEAR(squares, 1.0, 0.25);
}

TEST(Fit, IgnoresOutliersAndGaps) {
    std::vector<TrackPoint> points = tracks_of(three_cushion(), 3.0, 1e-3, 7);
    for (std::size_t i = 0; i < points.size(); i += 17) points[i].place.x() += 0.3;
    points.erase(points.begin() + 100, points.begin() + 160);
    const Fit found = fit(started(0.3), points, {kVary}, kernel::Isa::kScalar);
    EXPECT_TRUE(found.converged) << found.message;
    EXPECT_GE(found.outliers, points.size() / 18);
    for (std::size_t k = 0; k < kVary.size(); ++k) {
        const double truth = SceneNumber(three_cushion(), kVary[k]).value(three_cushion());
        EXPECT_LT(std::abs(found.values[k] - truth), 4.0 * found.deviations()[k]) << kVary[k];
    }
}

// The truth is at the end of a range, where a number has no derivative: steps shorten near it.
TEST(Fit, ReachesTheEndOfARange) {
    Scene scene = three_cushion();
    scene.balls.e_b = 1.0;
    const std::vector<TrackPoint> points = tracks_of(scene, 3.0, 0.0, 1);
    scene.balls.e_b = 0.98;
    const Fit found = fit(scene, points, {{"balls.e_b"}}, kernel::Isa::kScalar);
    EXPECT_GT(found.values[0], 0.995) << found.message;
}

TEST(Fit, ReportsUndeterminedNumbers) {
    Scene scene = three_cushion();
    // Before the first impact, nothing depends on the cushions, and the cue's mass and speed have the same
    // effect.
    const std::vector<TrackPoint> points = tracks_of(scene, 0.05, 0.0, 1);
    scene.cue->speed *= 1.001;
    const Fit found =
        fit(scene, points, {{"cue.speed", "cue.restitution", "balls.e_c_fit.0"}}, kernel::Isa::kScalar);
    ASSERT_EQ(found.warnings.size(), 2u);
    EXPECT_EQ(
        found.warnings[0],
        "the tracks hardly distinguish cue.speed from cue.restitution (correlation 1.0000); vary only one of "
        "them, or track another shot");
    EXPECT_EQ(found.warnings[1], "balls.e_c_fit.0 has no effect on the tracked positions");
    EXPECT_EQ(found.deviations()[2], std::numeric_limits<double>::infinity());
    EXPECT_LT(found.rms, 1e-8);
    EXPECT_THROW(fit(scene, {}, {kVary}, kernel::Isa::kScalar), std::invalid_argument);
    EXPECT_THROW(fit(scene, points, {{"cue.spede"}}, kernel::Isa::kScalar), std::invalid_argument);
}

}  // namespace
}  // namespace carom::games
