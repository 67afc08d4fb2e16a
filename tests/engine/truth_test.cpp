// Statements of tests/README.md in whole shots: T6 to T9, and a cushion's effect on a ball that then rolls
// again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carom/engine/cushion.h"
#include "support/engine_cases.h"

namespace carom {
namespace {

using namespace test;

constexpr double kRadPerDeg = 3.14159265358979323846 / 180.0;

// The object ball is at cut angle phi; the cue ball comes along +x at 1 m/s with R w_y = roll.
struct Hit {
    Record record;
    double time;  // of the impact
    Vec3 cue(double t) const { return record.state_at(0, t).velocity; }
    Vec3 object(double t) const { return record.state_at(1, t).velocity; }
    // Both roll from then on.
    double settled() const {
        double t = time;
        for (const Event& e : record.events)
            if (e.type == EventType::kSlideRoll) t = std::max(t, e.time);
        return t;
    }
};
Hit hit(double phi, double roll, double e_b) {
    Scene scene = instant_scene();
    scene.balls.mu_b = 0.0;
    scene.balls.e_b = e_b;
    const double R = scene.balls.R;
    add_ball(scene, "cue", 0.0, 0.0, 1.0, 0.0, Vec3(0.0, roll / R, 0.0));
    add_ball(scene, "1", 2.0 * R * std::cos(phi * kRadPerDeg), 2.0 * R * std::sin(phi * kRadPerDeg));
    Hit h{run_verified(scene), 0.0};
    EXPECT_EQ(h.record.events.front().type, EventType::kBallBall);
    h.time = h.record.events.front().time;
    return h;
}
double turned_deg(const Vec3& v) {
    return std::abs(std::atan2(v.y(), v.x())) / kRadPerDeg;
}

TEST(Truth, T6HeadOnStun) {
    for (const double e : {0.89, 0.92, 0.95, 0.98}) {
        const Hit h = hit(0.0, 0.0, e);
        EXPECT_NEAR(h.cue(h.time).x(), 0.5 * (1.0 - e), 1e-12);
        EXPECT_NEAR(h.object(h.time).x(), 0.5 * (1.0 + e), 1e-12);
    }
}

TEST(Truth, T7NinetyDegreeRule) {
    for (const double phi : {10.0, 30.0, 60.0, 80.0}) {
        const Hit h = hit(phi, 0.0, 1.0);
        EXPECT_LE(std::abs(h.cue(h.time).dot(h.object(h.time))), 1e-14) << phi;
    }
    const Hit h = hit(30.0, 0.0, 0.95);
    const double between = turned_deg(h.cue(h.time)) + turned_deg(h.object(h.time));
    EXPECT_NEAR(between, 90.0 - std::atan(0.05 / (2.0 * std::tan(30.0 * kRadPerDeg))) / kRadPerDeg, 1e-9);
}

TEST(Truth, T8ThirtyDegreeRule) {
    const double table[][2] = {{30.0, 33.67050},
                               {48.590377890729144, 27.2669},
                               {14.477512185929923, 27.6265},
                               {28.125505702055737, 33.748989}};
    for (const auto& row : table) {
        const Hit h = hit(row[0], 1.0, 1.0);
        EXPECT_NEAR(turned_deg(h.cue(h.settled())), row[1], 1e-4) << row[0];
    }
    EXPECT_NEAR(hit(30.0, 1.0, 1.0).cue(hit(30.0, 1.0, 1.0).settled()).norm(), 0.55787, 1e-5);
    EXPECT_NEAR(turned_deg(hit(30.0, 1.0, 0.95).cue(hit(30.0, 1.0, 0.95).settled())), 32.265, 1e-3);
}

// Draw: the return path is at about three times the cut angle. The numbers are exact, the rule is a rule of
// thumb.
TEST(Truth, T9TrisectRule) {
    const double table[][3] = {{10.0, 30.5, 24.8}, {20.0, 57.7, 48.6}, {30.0, 80.8, 70.9}};
    for (const auto& row : table) {
        const Hit soft = hit(row[0], -0.8, 1.0), full = hit(row[0], -1.0, 1.0);
        const double back = 180.0 - turned_deg(soft.cue(soft.settled()));
        EXPECT_NEAR(back, row[1], 0.05);
        EXPECT_NEAR(180.0 - turned_deg(full.cue(full.settled())), row[2], 0.05);
        EXPECT_NEAR(back, 3.0 * row[0], 0.11 * 3.0 * row[0]) << "rule of thumb";
    }
}

// Section 8: a rolling ball leaves a cushion sliding, and its remaining topspin bends its path back towards
// the cushion before it rolls again; straight in, it returns slower than e_c.
TEST(Truth, AfterACushionTheBallSlidesThenRollsAndTopspinBendsItBack) {
    for (const CushionModelInfo* model :
         {&kHan2005, cushion_model("mathavan_2010"), cushion_model("impulse"), cushion_model("stronge")}) {
        Scene scene = instant_scene();
        scene.table.cushions = {{"c1", {0.0, -5.0}, {0.0, 5.0}, 1.28 * scene.balls.R}};
        scene.physics.cushion = model;
        const double R = scene.balls.R, v = std::sqrt(0.5);
        add_ball(scene, "a", 0.2, 0.0, -v, v, rolling_spin(-v, v, R));
        const Record record = run_verified(scene);
        const Event* bounce = first(record, EventType::kBallCushion);
        ASSERT_NE(bounce, nullptr);
        const BallState after = record.state_at(0, bounce->time);
        ASSERT_EQ(after.state, MotionState::kSliding) << name(model);
        const Event* roll = first(record, EventType::kSlideRoll);
        ASSERT_NE(roll, nullptr);
        EXPECT_GT(roll->time, bounce->time);
        const Vec3 rolling = record.state_at(0, roll->time).velocity;
        EXPECT_GT(rolling.x(), 0.0) << name(model);
        EXPECT_GT(rolling.y() / rolling.x(), 1.05 * after.velocity.y() / after.velocity.x()) << name(model);
        EXPECT_LT(rolling.norm(), after.velocity.norm());

        Scene straight = scene;
        straight.ball.clear();
        add_ball(straight, "a", 0.2, 0.0, -1.0, 0.0, rolling_spin(-1.0, 0.0, R));
        const Record back = run_verified(straight);
        const Event* hit = first(back, EventType::kBallCushion);
        const double in = -back.state_at(0, std::nextafter(hit->time, 0.0)).velocity.x();
        const Vec3 out = back.state_at(0, hit->time).velocity;
        EXPECT_LT(out.x(), straight.balls.e_c * in) << name(model);
        EXPECT_GT(out.x(), 0.0);
        EXPECT_EQ(out.y(), 0.0);
    }
}

}  // namespace
}  // namespace carom
