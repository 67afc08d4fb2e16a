// Execution noise: the promised errors, reproducible by seed, and always a legal strike.
#include "carom/games/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "carom/engine/strike.h"
#include "carom/engine/variation.h"
#include "carom/kernel/splitmix64.h"
#include "support/engine_cases.h"

namespace carom::test {
namespace {

using games::Noise;
using games::noise_by_name;
using games::with_noise;

constexpr double kNoiseR = 0.028575;
constexpr Noise kOwn = {0.2, 0.3, 0.4, 0.01, 0.02};

Cue meant() {
    Cue cue;
    cue.speed = 4.0;
    cue.aim_deg = 33.0;
    cue.elevation_deg = 20.0;
    cue.side = 0.1;
    cue.height = -0.2;
    return cue;
}

TEST(Noise, ByNameHasThePublishedDeviations) {
    EXPECT_EQ(noise_by_name("none", kNoiseR), Noise());
    EXPECT_EQ(noise_by_name("ai3603", kNoiseR), (Noise{0.1, 0.1, 0.1, 0.003, 0.003}));
    const Noise fastfiz = noise_by_name("fastfiz", kNoiseR);
    EXPECT_EQ(fastfiz.speed, 0.075);
    EXPECT_EQ(fastfiz.aim_deg, 0.125);
    EXPECT_EQ(fastfiz.elevation_deg, 0.1);
    EXPECT_NEAR(fastfiz.side * kNoiseR, 0.0005, 1e-18);
    EXPECT_NEAR(fastfiz.height * kNoiseR, 0.0005, 1e-18);
    EXPECT_THROW(noise_by_name("fastfitz", kNoiseR), std::invalid_argument);
    EXPECT_THROW(noise_by_name("fastfiz", 0.0), std::invalid_argument);
}

TEST(Noise, NoNoiseKeepsEveryBit) {
    EXPECT_EQ(with_noise(meant(), Noise(), 7, 3), meant());
}

TEST(Noise, IsReproducibleBySeed) {
    EXPECT_EQ(with_noise(meant(), kOwn, 7, 3), with_noise(meant(), kOwn, 7, 3));
    EXPECT_NE(with_noise(meant(), kOwn, 7, 3), with_noise(meant(), kOwn, 7, 4));
    EXPECT_NE(with_noise(meant(), kOwn, 7, 3), with_noise(meant(), kOwn, 8, 3));
    // An error does not depend on the other uncertain quantities.
    const Noise aim_only = {0.0, kOwn.aim_deg, 0.0, 0.0, 0.0};
    const Cue one = with_noise(meant(), aim_only, 7, 3);
    EXPECT_EQ(one.aim_deg, with_noise(meant(), kOwn, 7, 3).aim_deg);
    EXPECT_EQ(one.speed, 4.0);
}

// Uses the draws of `carom sweep`, so that a sweep and a game agree.
TEST(Noise, DrawsLikeASweep) {
    const std::string text =
        "[[ball]]\nid = \"cue\"\n[cue]\nspeed = 4.0\naim_deg = 33.0\nelevation_deg = 20.0\noffset = [0.1, "
        "-0.2]\n";
    const Variation sweep = Variation::from_text(
        text, "noise",
        {"cue.speed=normal(0.2)", "cue.aim_deg=normal(0.3)", "cue.elevation_deg=normal(0.4)",
         "cue.offset.side=normal(0.01)", "cue.offset.height=normal(0.02)"},
        99);
    for (std::uint64_t shot = 0; shot < 50; ++shot) {
        const VariedShot varied = sweep.shot(shot);
        ASSERT_TRUE(varied.scene) << varied.error;
        const Cue here = with_noise(meant(), kOwn, 99, shot), there = *varied.scene->cue;
        EXPECT_EQ(here.speed, there.speed);
        EXPECT_EQ(here.aim_deg, there.aim_deg);
        EXPECT_EQ(here.elevation_deg, there.elevation_deg);
        EXPECT_EQ(here.side, there.side);
        EXPECT_EQ(here.height, there.height);
    }
}

// Means and deviations of many shots, within five standard errors.
TEST(Noise, HasItsDeviations) {
    constexpr int kShots = 20000;
    double Cue::*const numbers[] = {&Cue::speed, &Cue::aim_deg, &Cue::elevation_deg, &Cue::side,
                                    &Cue::height};
    const double deviations[] = {kOwn.speed, kOwn.aim_deg, kOwn.elevation_deg, kOwn.side, kOwn.height};
    for (int k = 0; k < 5; ++k) {
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < kShots; ++i) {
            const double error = with_noise(meant(), kOwn, 1, i).*numbers[k] - meant().*numbers[k];
            sum += error / deviations[k];
            squares += error * error / (deviations[k] * deviations[k]);
        }
        EXPECT_NEAR(sum / kShots, 0.0, 5.0 / std::sqrt(kShots)) << k;
        EXPECT_NEAR(squares / kShots, 1.0, 5.0 * std::sqrt(2.0 / kShots)) << k;
    }
}

// Strikes at every limit, with noise as large as the range.
TEST(Noise, IsAlwaysALegalStrike) {
    Scene scene = empty_scene();
    add_ball(scene, "cue", 0.5, 0.5);
    const Noise wild = {3.0, 400.0, 60.0, 0.6, 0.6};
    int stopped = 0, level = 0, at_rim = 0;
    for (std::uint64_t i = 0; i < 3000; ++i) {
        Cue cue;
        cue.speed = 0.5 * static_cast<double>(i % 3);
        cue.elevation_deg = i % 2 == 0 ? 0.0 : 89.0;
        cue.height = 0.5 * static_cast<double>(i % 5 == 0);
        scene.cue = with_noise(cue, wild, 5, i);
        ASSERT_NO_THROW(validate(scene)) << i;
        stopped += scene.cue->speed == 0.0;
        level += scene.cue->elevation_deg == 0.0;
        const double r2 = scene.cue->side * scene.cue->side + scene.cue->height * scene.cue->height;
        at_rim += r2 > 0.25 * (1.0 - 1e-14);
    }
    EXPECT_GT(stopped, 300);
    EXPECT_GT(level, 300);
    EXPECT_GT(at_rim, 300);
}

TEST(Noise, RefusesNanAndNegativeDeviations) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(with_noise(meant(), {nan, 0.0, 0.0, 0.0, 0.0}, 1, 1), std::invalid_argument);
    EXPECT_THROW(with_noise(meant(), {0.0, 0.0, 0.0, -0.1, 0.0}, 1, 1), std::invalid_argument);
    Cue cue = meant();
    cue.side = nan;
    EXPECT_THROW(with_noise(cue, Noise(), 1, 1), std::invalid_argument);
}

TEST(LegalStrike, KeepsLegalStrikesAndTheDirectionOfOthers) {
    EXPECT_EQ(legal_strike(meant()), meant());
    SplitMix64 random(3);
    for (int i = 0; i < 10000; ++i) {
        Cue cue;
        cue.side = 4.0 * random.uniform() - 2.0;
        cue.height = 4.0 * random.uniform() - 2.0;
        const Cue legal = legal_strike(cue);
        const double r2 = cue.side * cue.side + cue.height * cue.height;
        const double to2 = legal.side * legal.side + legal.height * legal.height;
        ASSERT_LE(to2, kMiscueOffset * kMiscueOffset);
        if (r2 <= 0.25)
            ASSERT_EQ(legal, cue);
        else {
            ASSERT_NEAR(to2, 0.25, 1e-14);
            ASSERT_NEAR(legal.side * cue.height - legal.height * cue.side, 0.0, 1e-15);
        }
    }
    Cue far;
    far.side = 1e300;
    far.height = -1e300;
    EXPECT_NEAR(legal_strike(far).side, std::sqrt(0.125), 1e-15);
    EXPECT_LT(legal_strike(far).height, 0.0);
}

}  // namespace
}  // namespace carom::test
