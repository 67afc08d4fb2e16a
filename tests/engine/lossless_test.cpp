// Lossless balls keep their energy however fast they bounce, and the checker requires it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "reference/random_impacts.h"
#include "support/hard_scenes.h"

namespace carom::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

Scene lossless_scene(double R) {
    Scene scene = frictionless();
    scene.balls.R = R;
    return scene;
}

double speed(const Record& record, int ball) {
    return record.state_at(ball, record.duration).velocity.norm();
}

// Pi from collisions (G. Galperin, "Playing pool with pi", 2003): a ball between a wall and a ball of 100^n
// times its mass meets the two floor(pi 10^n) times. Up to 1100 contacts in 1e-5 s once counted as coming to
// rest, after 5094 of 31415 events.
TEST(Lossless, PiFromCollisions) {
    for (const auto& [ratio, collisions] :
         {std::pair{1.0, 3}, {1e2, 31}, {1e4, 314}, {1e6, 3141}, {1e8, 31415}}) {
        Scene scene = lossless_scene(0.03);
        scene.table.cushions.push_back({"wall", {0.0, -1.0}, {0.0, 1.0}, 0.03});
        scene.balls.m = 0.01;
        add_ball(scene, "light", 0.5, 0.0);
        add_ball(scene, "heavy", 1.0, 0.0, -1.0, 0.0);
        scene.ball.back().own = BallSize{0.03, 0.01 * ratio};
        scene.stop.events = 100000;
        const Record record = run_verified(scene);
        EXPECT_EQ(record.events.size(), static_cast<std::size_t>(collisions)) << ratio;
    }
}

// The same on a cloth that would stop the balls: here the closing speed has not fallen.
TEST(Lossless, PiFromCollisionsOnACloth) {
    Scene scene = lossless_scene(0.03);
    scene.balls.mu_s = scene.balls.mu_r = 1e-12;
    scene.table.cushions.push_back({"wall", {0.0, -1.0}, {0.0, 1.0}, 0.03});
    scene.balls.m = 0.01;
    add_ball(scene, "light", 0.5, 0.0);
    add_ball(scene, "heavy", 1.0, 0.0, -1.0, 0.0);
    scene.ball.back().own = BallSize{0.03, 0.01 * 1e8};
    scene.stop.time = 1.5;
    const Record record = run_verified(scene);
    EXPECT_EQ(count(record, EventType::kBallBall) + count(record, EventType::kBallCushion), 31415);
}

// Straight into a wedge, meeting both noses at once, at any table angle: the ball returns with all its speed.
// A wedge of 1 degree silently returned 0.913 of it.
TEST(Lossless, AWedgeReturnsAllSpeed) {
    for (const double wedge : {0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0}) {
        for (int turn = 0; turn < 72; ++turn) {
            const double half = 0.5 * wedge * kDegree, angle = 5.0 * turn * kDegree + 0.001 * turn;
            const double R = 0.0286;
            Scene scene = lossless_scene(R);
            const auto at = [&](double along, double direction) {
                return Vec2(along * std::cos(angle + direction), along * std::sin(angle + direction));
            };
            scene.table.cushions.push_back({"a", {0.0, 0.0}, at(20.0, half), R});
            scene.table.cushions.push_back({"b", {0.0, 0.0}, at(20.0, -half), R});
            const Vec2 start = at(R / std::sin(half) + 0.5, 0.0), back = at(1.0, 0.0);
            add_ball(scene, "ball", start.x(), start.y(), -back.x(), -back.y());
            scene.stop.time = 1.0;
            const Record record = run_verified(scene);
            EXPECT_NEAR(speed(record, 0), 1.0, 1e-12) << wedge << " degrees, turned by " << angle;
            // It meets both at once if rounding of its place allows it.
            EXPECT_GE(record.events.size(), 2u);
        }
    }
}

// Any direction into any wedge: all necessary reflections, no loss.
TEST(Lossless, AWedgeFromAnySide) {
    reference::Generator rng(31);
    for (int n = 0; n < 300; ++n) {
        const double R = 0.0286, half = rng.uniform(0.25, 40.0) * kDegree;
        Scene scene = lossless_scene(R);
        scene.table.cushions.push_back({"a", {0.0, 0.0}, {20.0 * std::cos(half), 20.0 * std::sin(half)}, R});
        scene.table.cushions.push_back({"b", {0.0, 0.0}, {20.0 * std::cos(half), -20.0 * std::sin(half)}, R});
        const double angle = rng.uniform(-0.9, 0.9) * half;
        add_ball(scene, "ball", R / std::sin(half) + 0.5, 0.0, -std::cos(angle), std::sin(angle));
        scene.stop.time = 1.0;
        EXPECT_NEAR(speed(run_verified(scene), 0), 1.0, 1e-11) << n;
    }
}

// A grain between two touching posts bounces faster and faster, and comes back out.
TEST(Lossless, TouchingPostsReturnABall) {
    for (const double y : {0.0, 1e-15, 1e-9, 1e-7, 1e-5}) {
        Scene scene = lossless_scene(2e-6);
        scene.table.jaws.push_back({"j1", {0.0, 1.0}, 1.0, 2e-6});
        scene.table.jaws.push_back({"j2", {0.0, -1.0}, 1.0, 2e-6});
        add_ball(scene, "grain", 1.0, y, -1.0, 0.0);
        scene.stop.time = 3.0;
        const Record record = run_verified(scene);
        EXPECT_NEAR(speed(record, 0), 1.0, 1e-10) << y;
        EXPECT_GT(record.state_at(0, record.duration).position.x(), 0.5) << y;
    }
}

// Ten thousand bounces a second between near walls, until the run is stopped.
TEST(Lossless, AGrainBetweenNearWalls) {
    Scene scene = lossless_scene(1e-3);
    scene.table.cushions.push_back({"left", {0.0, -1.0}, {0.0, 1.0}, 1e-3});
    scene.table.cushions.push_back({"right", {2e-3 + 1e-8, -1.0}, {2e-3 + 1e-8, 1.0}, 1e-3});
    add_ball(scene, "grain", 1e-3 + 0.5e-8, 0.0, 1.0, 1e-3);
    scene.stop.time = 1e-4;
    const Record record = run_verified(scene);
    EXPECT_EQ(count(record, EventType::kBallCushion), 10000);
    EXPECT_EQ(count(record, EventType::kBallCushionHold), 0);
    EXPECT_NEAR(speed(record, 0), std::hypot(1.0, 1e-3), 1e-12);
}

// A light ball between two heavy ones passes their energy on. From a mass ratio of 3e4 on, half was once
// lost.
TEST(Lossless, AHeavyLinePassesItsMotionOn) {
    for (const double ratio : {1e4, 1e5, 1e6}) {
        for (const int light : {1, 2}) {
            Scene scene = lossless_scene(0.03);
            scene.physics.gravity = 0.0;
            for (int k = 0; k < light + 2; ++k) {
                add_ball(scene, std::to_string(k), 0.06 * k + (k > 0 ? 1e-9 : 0.0), 0.0, k == 0 ? 1.0 : 0.0);
                const bool heavy = k == 0 || k == light + 1;
                scene.ball.back().own = BallSize{0.03, (heavy ? ratio : 1.0) * scene.balls.m};
            }
            scene.stop.time = 0.1;
            const Record record = run_verified(scene);
            EXPECT_NEAR(speed(record, 0), 0.0, 1e-3) << ratio << " " << light;
            EXPECT_NEAR(speed(record, light + 1), 1.0, 1e-3) << ratio << " " << light;
        }
    }
}

TEST(Lossless, TheCheckerRequiresTheEnergyOfABounce) {
    Scene scene = lossless_scene(0.03);
    scene.table.cushions.push_back({"wall", {0.0, -1.0}, {0.0, 1.0}, 0.03});
    add_ball(scene, "ball", 0.5, 0.0, -1.0, 0.1);
    scene.stop.time = 2.0;
    const Plan plan = plan_of(scene);
    Record record = simulate(plan);
    EXPECT_FALSE(verify(record, plan));
    record.tracks[0].segments.back().v *= 0.999;
    const auto violation = verify(record, plan);
    ASSERT_TRUE(violation);
    EXPECT_EQ(violation->law, "U5");
}

// Only the steps of a cluster may lose energy. A cluster once lost half of it unnoticed.
TEST(Lossless, TheCheckerRequiresTheEnergyOfAClusterToo) {
    for (const double share : {1.0, 1.0 - 1e-4}) {
        Scene scene = lossless_scene(0.03);
        for (int k = 0; k < 3; ++k)
            add_ball(scene, std::to_string(k), k == 0 ? -0.001 : 0.06 * k, 0.0, k == 0 ? 1.0 : 0.0);
        scene.stop.time = 0.1;
        const Plan plan = plan_of(scene);
        Record record = simulate(plan);
        ASSERT_EQ(count(record, EventType::kBallCluster), 1);
        for (BallTrack& track : record.tracks) track.segments.back().v *= share;
        const auto violation = verify(record, plan);
        EXPECT_EQ(violation.has_value(), share < 1.0);
        if (violation) {
            // The momentum is also reduced.
            EXPECT_TRUE(violation->law == "U4" || violation->law == "U5") << violation->message;
        }
    }
}

}  // namespace
}  // namespace carom::test
