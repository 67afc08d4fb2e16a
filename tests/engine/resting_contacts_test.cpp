// Resting contacts: H4, H5, H7 to H9 of tests/README.md with the numbers of the design notes (clusters,
// sections 7 and 9).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "carom/engine/cushion.h"

#include "support/engine_cases.h"

namespace carom {
namespace {

using namespace test;

struct Push {
    int pushed;
    double mu_b, a, t, v, x;
};

// H7: a ball with 100 rad/s of topspin at rest behind n touching balls, mu_r = 0.
TEST(RestingContacts, TopspinPushesALine) {
    const Push table[] = {{1, 0.0, 0.81750000, 0.499345, 0.408214, 0.101920},
                          {2, 0.0, 0.51631579, 0.527086, 0.272143, 0.071721},
                          {3, 0.0, 0.37730769, 0.540957, 0.204107, 0.055207},
                          {1, 0.05, 0.78845178, 0.491855, 0.387804, 0.095371},
                          {2, 0.05, 0.47465621, 0.517015, 0.245404, 0.063439},
                          {3, 0.05, 0.32964911, 0.529533, 0.174560, 0.046218}};
    for (const Push& row : table) {
        const std::string label =
            "n = " + std::to_string(row.pushed) + ", mu_b = " + std::to_string(row.mu_b);
        Scene scene = empty_scene();
        scene.balls.mu_r = 0.0;
        scene.balls.mu_b = row.mu_b;
        scene.stop.time = 1.0;
        const double R = scene.balls.R;
        add_ball(scene, "cue", 0.0, 0.0, 0.0, 0.0, Vec3(-100.0, 0.0, 0.0));
        for (int i = 1; i <= row.pushed; ++i) add_ball(scene, std::to_string(i), 0.0, 2.0 * i * R);
        const Record record = run_verified(scene);
        const Event* roll = first(record, EventType::kSlideRoll);
        ASSERT_NE(roll, nullptr) << label;
        EXPECT_NEAR(roll->time, row.t, 1e-6) << label;
        EXPECT_NEAR(record.state_at(0, roll->time).velocity.y(), row.v, 1e-6) << label;
        EXPECT_NEAR(record.state_at(0, roll->time).position.y(), row.x, 1e-6) << label;
        EXPECT_NEAR(record.state_at(0, 0.3).velocity.y() / 0.3, row.a, 1e-8) << label;
        EXPECT_LE(record.events.size(), 20u) << label;
        // From then on all roll equally, still touching.
        for (int i = 1; i <= row.pushed; ++i)
            EXPECT_NEAR(record.state_at(i, 0.9).position.y() - record.state_at(i - 1, 0.9).position.y(),
                        2.0 * R, 1e-11)
                << label;
    }
}

// H5: spin into the cushion from rest: the contact lasts until the slip ends, R w / (2.5 mu_s g).
TEST(RestingContacts, SpinIntoACushion) {
    Scene scene = empty_scene();
    scene.table = box(1.0, 2.0, 0.036576);
    const double R = scene.balls.R;
    add_ball(scene, "a", 1.0 - R, 1.0, 0.0, 0.0, Vec3(0.0, 50.0, 0.0));
    const Record record = run_verified(scene);
    const Event* roll = first(record, EventType::kSlideRoll);
    ASSERT_NE(roll, nullptr);
    EXPECT_NEAR(roll->time, R * 50.0 / (2.5 * 0.2 * 9.81), 1e-9);
    for (const double t : {0.0, 0.1, 0.2, 0.29, 1.0})
        EXPECT_NEAR(record.state_at(0, t).position.x(), 1.0 - R, 1e-12);
    EXPECT_LE(record.events.size(), 6u);
}

// H5, oblique: 1 m/s along the cushion and 50 rad/s into it. The notes' reference values: 0.328069 s, v_y =
// 5/7.
TEST(RestingContacts, ObliqueSpinIntoACushion) {
    Scene scene = empty_scene();
    scene.table = box(1.0, 20.0, 0.036576);
    const double R = scene.balls.R;
    add_ball(scene, "a", 1.0 - R, 1.0, 0.0, 1.0, Vec3(0.0, 50.0, 0.0));
    const Record record = run_verified(scene);
    const Event* roll = first(record, EventType::kSlideRoll);
    ASSERT_NE(roll, nullptr);
    EXPECT_NEAR(roll->time, 0.328069, 2e-5);
    EXPECT_NEAR(record.state_at(0, roll->time).velocity.y(), 5.0 / 7.0, 2e-5);
    EXPECT_NEAR(record.state_at(0, roll->time).position.x(), 1.0 - R, 1e-12);
    EXPECT_LE(record.events.size(), 12u);
}

// Spin presses a ball to a cushion. Struck along the cushion, the ball stays in contact; struck into it, it
// bounces.
TEST(RestingContacts, ContinueThroughAnImpactAlongTheCushion) {
    for (const bool oblique : {false, true}) {
        Scene scene = empty_scene();
        scene.table = box(1.0, 4.0, 0.036576);
        scene.balls.mu_b = 0.0;
        scene.stop.time = 0.2;
        const double R = scene.balls.R;
        add_ball(scene, "a", 1.0 - R, 2.0, 0.0, 0.0, Vec3(0.0, 50.0, 0.0));
        add_ball(scene, "b", oblique ? 1.0 - 1.2 * R : 1.0 - R, 2.0 - 4.0 * R, 0.0, 1.0);
        const Record record = run_verified(scene);
        const Event* hit = first(record, EventType::kBallBall);
        ASSERT_NE(hit, nullptr);
        const auto count = [&](EventType type) {
            return std::count_if(record.events.begin(), record.events.end(), [&](const Event& e) {
                return e.type == type && e.a == 0 && e.time <= hit->time + 1e-9;
            });
        };
        EXPECT_EQ(count(EventType::kBallCushionHold), 1);
        EXPECT_EQ(count(EventType::kBallCushionRelease), oblique ? 1 : 0);
        EXPECT_EQ(count(EventType::kBallCushion), oblique ? 1 : 0);
    }
}

// H4: a ball exactly at the cushion, moving into it, rebounds at once.
TEST(RestingContacts, BallAtTheCushionRebounds) {
    for (const double offset : {0.0, -1e-12, 1e-12, 1e-9}) {
        Scene scene = empty_scene();
        scene.table = box(1.0, 2.0, 0.036576);
        scene.physics.cushion = &kSmooth;
        const double R = scene.balls.R;
        add_ball(scene, "a", 1.0 - R - offset, 0.7, 1.0, 0.0, rolling_spin(1.0, 0.0, R));
        const Record record = run_verified(scene);
        ASSERT_FALSE(record.events.empty());
        EXPECT_EQ(record.events[0].type, EventType::kBallCushion) << offset;
        EXPECT_LE(record.events[0].time, 2e-9) << offset;
        EXPECT_NEAR(record.state_at(0, record.events[0].time).velocity.x(), -0.85, 1e-9) << offset;
        for (double t = 0.0; t < record.duration; t += 0.05)
            EXPECT_LE(record.state_at(0, t).position.x(), 1.0 - R + 1e-12);
    }
}

// H8: two balls rolling side by side, touching: no event between them.
TEST(RestingContacts, RollingSideBySide) {
    for (const bool behind : {false, true}) {
        Scene scene = empty_scene();
        const double R = scene.balls.R;
        add_ball(scene, "a", 0.0, 0.0, 0.0, 1.0, rolling_spin(0.0, 1.0, R));
        add_ball(scene, "b", behind ? 0.0 : 2.0 * R, behind ? 2.0 * R : 0.0, 0.0, 1.0,
                 rolling_spin(0.0, 1.0, R));
        const Record record = run_verified(scene);
        EXPECT_EQ(record.events.size(), 2u) << "the two stops";
        const double stop = 1.0 / (0.01 * 9.81);
        for (const double t : {0.3, 5.0, stop})
            EXPECT_NEAR((record.state_at(0, t).position - record.state_at(1, t).position).norm(), 2.0 * R,
                        behind ? 2e-15 : 0.0);
        EXPECT_NEAR(record.duration, stop, 1e-13);
    }
}

// H9: exactly at 2 R, receding or at rest: no event; one ulp inside and closing: now.
TEST(RestingContacts, TouchingPairs) {
    const double R = pool_balls().R;
    Scene rest = empty_scene();
    add_ball(rest, "a", 0.0, 0.0);
    add_ball(rest, "b", 2.0 * R, 0.0);
    EXPECT_TRUE(run_verified(rest).events.empty());
    Scene receding = empty_scene();
    add_ball(receding, "a", 0.0, 0.0);
    add_ball(receding, "b", 2.0 * R, 0.0, 1.0, 0.0, rolling_spin(1.0, 0.0, R));
    EXPECT_EQ(count(run_verified(receding), EventType::kBallBall), 0);
    Scene closing = empty_scene();
    add_ball(closing, "a", 0.0, 0.0);
    add_ball(closing, "b", std::nextafter(2.0 * R, 0.0), 0.0, -1.0, 0.0, rolling_spin(-1.0, 0.0, R));
    const Record record = run_verified(closing);
    ASSERT_FALSE(record.events.empty());
    EXPECT_EQ(record.events[0].type, EventType::kBallBall);
    EXPECT_EQ(record.events[0].time, 0.0);
}

}  // namespace
}  // namespace carom
