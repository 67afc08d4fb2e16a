// 10 000 seeded scenes to rest without a violation, and the regressions they brought
// (support/random_scenes.h).
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "support/random_scenes.h"

namespace carom {
namespace {

using namespace test;

constexpr int kParts = 20, kScenes = 10000;

class RandomScenes : public testing::TestWithParam<int> {};

TEST_P(RandomScenes, ComeToRest) {
    for (int seed = GetParam() * (kScenes / kParts); seed < (GetParam() + 1) * (kScenes / kParts); ++seed) {
        const Scene scene = RandomScene(static_cast<std::uint64_t>(seed)).make();
        const std::string what = what_breaks(scene);
        EXPECT_EQ(what, "") << "seed " << seed << "\n" << dump(scene);
    }
}

INSTANTIATE_TEST_SUITE_P(Part, RandomScenes, testing::Range(0, kParts));

// CAROM_RANDOM_SCENES=FROM:COUNT runs these seeds and prints a line for each that fails or takes long; for
// whoever changes sustained contacts. It asserts nothing about time.
TEST(RandomSceneScan, PrintsWhatFailsOrTakesLong) {
    const char* wanted = std::getenv("CAROM_RANDOM_SCENES");
    if (wanted == nullptr) GTEST_SKIP() << "set CAROM_RANDOM_SCENES=FROM:COUNT to run it";
    unsigned long long from = 0, count = 0;
    ASSERT_EQ(std::sscanf(wanted, "%llu:%llu", &from, &count), 2) << "CAROM_RANDOM_SCENES=FROM:COUNT";
    using Clock = std::chrono::steady_clock;
    const double slow_ms = 300.0, give_up_ms = 1000.0;
    double total_ms = 0.0;
    int failed = 0;
    for (unsigned long long seed = from; seed < from + count; ++seed) {
        const Scene scene = RandomScene(seed).make();
        const Clock::time_point start = Clock::now();
        const auto taken = [start] {
            return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
        };
        std::size_t rounds = 0;
        SimulateOptions options;
        options.progress = [&](std::size_t, double time) {
            if (++rounds % 64 == 0 && taken() > give_up_ms)
                throw std::runtime_error("given up at t = " + std::to_string(time) + " s");
        };
        const std::string what = what_breaks(scene, options);
        const double ms = taken();
        total_ms += ms;
        failed += what.empty() ? 0 : 1;
        if (!what.empty() || ms > slow_ms)
            std::printf("seed %llu: %.0f ms, %zu rounds: %s\n", seed, ms, rounds, what.c_str());
        std::fflush(stdout);
    }
    std::printf("%llu scenes from %llu: %d failed, %.1f ms on average\n", count, from, failed,
                total_ms / static_cast<double>(count));
}

/// The seven-foot table's cushion and jaw where a ball stood at their join.
Table cushion_and_jaw() {
    Table table;
    table.width = 0.9906;
    table.length = 1.9812;
    table.cushions = {{"c18", {0.8995982772122183, 0.0}, {0.091001722787781708, 0.0}, 0.036576}};
    table.jaws = {{"j12", {0.8995982772122183, -0.02095}, 0.02095, 0.036576}};
    return table;
}

Scene smooth_scene(ClusterModel clusters = ClusterModel::kSequential) {
    Scene scene = empty_scene();
    scene.balls.mu_b = 0.0;
    scene.physics.ball_ball = BallBallModel::kElastic;
    scene.physics.cushion = CushionModel::kSmooth;
    scene.physics.clusters = clusters;
    return scene;
}

// A ball held to a cushion lets go of it at the cushion's end. It went round for ever there.
TEST(RandomSceneRegressions, OffTheEndOfACushion) {
    Scene scene = smooth_scene();
    scene.table.cushions = {{"c3", {0.0, 0.091001722787781708}, {0.0, 0.91508373076875005}, 0.036576}};
    scene.balls.mu_s = 0.6;
    scene.balls.e_c = 0.0;
    add_ball(scene, "14", 0.30867884068796231, 0.71580989896748548, -7.1357863660954077, 0.077123077199810583,
             Vec3(183.59121245570637, -291.18699124810286, 28.434528466564402));
    EXPECT_EQ(what_breaks(scene), "");
}

// A ball that has stopped stays: a velocity of 1e-20 m/s was stopped again and again.
TEST(RandomSceneRegressions, StoppedPushedBall) {
    Scene scene = smooth_scene();
    scene.balls.mu_s = 0.05;
    add_ball(scene, "1", 0.55245100000000003, 1.525452435703369);
    add_ball(scene, "3", 0.5810265, 1.5749466535550534);
    add_ball(scene, "4", 0.60960199999999998, 1.6244408714067378);
    add_ball(scene, "9", 0.52387550000000005, 1.4759582178516844, 0.0, 0.0,
             Vec3(0.4378448403207158, 7.3395409822137019, -6.1226418398206057));
    EXPECT_EQ(what_breaks(scene), "");
}

// Rolling friction brakes a ball; it does not drive one that was held at rest. The energy rose from 0.
TEST(RandomSceneRegressions, HeldBallDoesNotStartByItself) {
    Scene scene = empty_scene();
    scene.table.cushions = {{"right", {1.0, 2.0}, {1.0, 0.0}, 0.036576}};
    scene.physics.ball_ball = BallBallModel::kElastic;
    scene.physics.clusters = ClusterModel::kSequential;
    scene.balls.mu_s = scene.balls.mu_r = 0.05;
    scene.balls.e_c = 0.0;
    add_ball(scene, "9", 0.6950051009078293, 1.6528781070028749, 0.0, 0.0,
             Vec3(-35.837978173050871, 303.8618430760348, 0.0));
    add_ball(scene, "10", 0.97142499999900001, 1.971425);
    EXPECT_EQ(what_breaks(scene), "");
}

// From the jaw onto the cushion: noticed where the cushion begins, and captured without closing on either.
TEST(RandomSceneRegressions, FromAJawOntoTheCushion) {
    Scene scene = smooth_scene();
    scene.table = cushion_and_jaw();
    add_ball(scene, "7", 0.8995982772122183, 0.028575, 0.0, 0.0,
             Vec3(7.8366512943658257, -1.5873334438344489, 5.6399809888732193));
    EXPECT_EQ(what_breaks(scene), "");
}

}  // namespace
}  // namespace carom
