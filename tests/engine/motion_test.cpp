// Closed-form motion: truth data T1..T5 of tests/README.md and the reference vectors of motion.json.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "physics/motion.h"
#include "support/engine_cases.h"

namespace carom {
namespace {

using namespace test;

void expect_near(const Vec3& a, const Vec3& b, double tolerance, const std::string& what) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << what << ", component " << k;
}

TEST(Motion, StunTurnsIntoRolling) {  // T1
    for (const double mu : {0.2, 0.212}) {
        Scene scene = empty_scene();
        scene.balls.mu_s = mu;
        add_ball(scene, "a", 0, 0, 1.0, 0.0);
        const Record record = run_verified(scene);
        const Event* roll = first(record, EventType::kSlideRoll);
        ASSERT_NE(roll, nullptr);
        const double g = scene.physics.gravity;
        EXPECT_NEAR(roll->time, 2.0 / (7.0 * mu * g), 1e-15);
        const BallState state = record.state_at(0, roll->time);
        EXPECT_NEAR(state.velocity.x(), 5.0 / 7.0, 1e-15);
        EXPECT_NEAR(state.position.x(), 12.0 / (49.0 * mu * g), 1e-15);
        EXPECT_EQ(state.state, MotionState::kRolling);
    }
}

TEST(Motion, AnyStartEndsOnTheParabola) {  // T2
    Scene scene = empty_scene();
    add_ball(scene, "a", 0, 0, 1.5, 0.0, Vec3(-60.0, 20.0, 0.0));
    const Record record = run_verified(scene);
    const Event* roll = first(record, EventType::kSlideRoll);
    ASSERT_NE(roll, nullptr);
    EXPECT_NEAR(roll->time, 0.28393403, 5e-9);
    const BallState state = record.state_at(0, roll->time);
    expect_near(state.velocity, Vec3(1.2347143, 0.4898571, 0.0), 5e-8, "v_f");
    expect_near(state.position, Vec3(0.38823922, 0.06954356, scene.balls.R), 5e-9, "end of the parabola");
    EXPECT_NEAR(std::atan2(state.velocity.y(), state.velocity.x()) * 180.0 / M_PI, 21.64007, 5e-6);
}

TEST(Motion, AngularMomentumAboutTheClothIsKeptWhileSliding) {  // T3
    Scene scene = empty_scene();
    add_ball(scene, "a", 0, 0, 1.5, -0.7, Vec3(-60.0, 20.0, 35.0));
    const Record record = run_verified(scene);
    const auto invariant = [&](double t) {
        const BallState s = record.state_at(0, t);
        // v - (2/5) R (z x w_xy)
        return Vec2(s.velocity.x() + 0.4 * scene.balls.R * s.spin.y(),
                    s.velocity.y() - 0.4 * scene.balls.R * s.spin.x());
    };
    const Event* roll = first(record, EventType::kSlideRoll);
    ASSERT_NE(roll, nullptr);
    for (const double share : {0.1, 0.5, 0.999})
        EXPECT_LT((invariant(share * roll->time) - invariant(0.0)).norm(), 1e-14);
}

TEST(Motion, RollsToRest) {  // T4
    Scene scene = empty_scene();
    add_ball(scene, "a", 0, 0, 1.0, 0.0, rolling_spin(1.0, 0.0, scene.balls.R));
    const Record record = run_verified(scene);
    ASSERT_EQ(record.events.size(), 1u);
    EXPECT_EQ(record.events[0].type, EventType::kRollStop);
    EXPECT_NEAR(record.duration, 1.0 / (0.01 * 9.81), 1e-14);
    EXPECT_NEAR(record.state_at(0, record.duration).position.x(), 1.0 / (2 * 0.01 * 9.81), 1e-14);
    EXPECT_EQ(record.state_at(0, record.duration).velocity, Vec3::Zero());
}

TEST(Motion, SpinDecaysAtItsRate) {  // T5, H28
    Scene scene = empty_scene();
    add_ball(scene, "a", 0.3, 0.4, 0.0, 0.0, Vec3(0.0, 0.0, 100.0));
    const Record record = run_verified(scene);
    const double alpha = 5.0 * 0.0127 * 9.81 / (2.0 * scene.balls.R);
    EXPECT_NEAR(alpha, 10.9, 0.001);
    ASSERT_EQ(record.events.size(), 1u);
    EXPECT_EQ(record.events[0].type, EventType::kSpinStop);
    EXPECT_NEAR(record.duration, 100.0 / alpha, 1e-13);
    EXPECT_NEAR(record.state_at(0, 1.0).spin.z(), 100.0 - alpha, 1e-12);
    EXPECT_EQ(record.state_at(0, record.duration).position, scene.ball[0].position) << "translates";
}

TEST(Motion, SlowBallComesToRestInOneEvent) {  // H21
    Scene scene = empty_scene();
    add_ball(scene, "a", 0.3, 0.4, 1e-8, 0.0, rolling_spin(1e-8, 0.0, scene.balls.R));
    const Record record = run_verified(scene);
    EXPECT_EQ(record.events.size(), 1u);
    EXPECT_NEAR(record.duration, 1e-8 / 0.0981, 1e-20);
}

// Seed 145147 of the other family of random scenes: a thousand simultaneous impacts, each at half the speed
// of the last. Spin about the vertical must not matter: zigzag/wide 31974.
TEST(Motion, SpeedsTooSmallToDivideFrictionByAreRest) {
    const MotionParams params{.R = 0.028575, .slide = 1.962, .roll = 0.0981, .spin = 10.9};
    for (const double speed : {1e-310, 5e-309, 1e-260, 1e-163}) {
        for (const Vec3& spin :
             {Vec3(0, 0, 0), Vec3(speed / params.R, 0, 0), Vec3(0, 0, speed), Vec3(0, 0, 0.2)}) {
            const Segment s = start_segment(1.0, Vec3(0.5, 0.5, params.R), Vec3(0, -speed, 0), spin, params);
            EXPECT_EQ(s.state, spin.z() == 0.0 ? MotionState::kStationary : MotionState::kSpinning) << speed;
            EXPECT_EQ(s.v, Vec3::Zero()) << speed;
            EXPECT_EQ(s.w, Vec3(0, 0, spin.z())) << speed;
            EXPECT_EQ(s.a, Vec2::Zero()) << speed;
        }
    }
    const Segment moves =
        start_segment(1.0, Vec3(0.5, 0.5, params.R), Vec3(0, -1e-99, 0), Vec3::Zero(), params);
    EXPECT_EQ(moves.state, MotionState::kSliding);
}

TEST(Motion, ReferenceVectors) {
    const auto data = read_json("motion.json");
    const std::map<std::string, EventType> types{{"sliding_rolling", EventType::kSlideRoll},
                                                 {"rolling_spinning", EventType::kRollSpin},
                                                 {"rolling_stationary", EventType::kRollStop},
                                                 {"spinning_stationary", EventType::kSpinStop}};
    for (const auto& c : data.at("cases")) {
        const std::string label = "case " + c.at("id").dump();
        Scene scene = empty_scene();
        scene.balls = balls_from(c.at("params"));
        scene.physics.gravity = c.at("params").at("g").get<double>();
        const auto& initial = c.at("initial");
        add_ball(scene, "a", vec3(initial.at("r")), vec3(initial.at("v")), vec3(initial.at("w")));
        const Record record = run_verified(scene);
        const auto& transitions = c.at("transitions");
        ASSERT_EQ(record.events.size(), transitions.size()) << label;
        for (std::size_t i = 0; i < record.events.size(); ++i) {
            EXPECT_EQ(record.events[i].type, types.at(transitions[i].at("type").get<std::string>())) << label;
            EXPECT_NEAR(record.events[i].time, transitions[i].at("t").get<double>(), 1e-9) << label;
            const BallState state = record.state_at(0, record.events[i].time);
            const auto& after = transitions[i].at("state_after");
            EXPECT_EQ(static_cast<int>(state.state), after.at("s").get<int>()) << label;
            expect_near(state.position, vec3(after.at("r")), 1e-9, label);
            expect_near(state.velocity, vec3(after.at("v")), 1e-9, label);
            expect_near(state.spin, vec3(after.at("w")), 1e-9, label);
        }
        for (const auto& sample : c.at("samples")) {
            const BallState state = record.state_at(0, sample.at("t").get<double>());
            expect_near(state.position, vec3(sample.at("r")), 1e-9, label);
            expect_near(state.velocity, vec3(sample.at("v")), 1e-9, label);
            expect_near(state.spin, vec3(sample.at("w")), 1e-9, label);
        }
    }
}

// Orientation: a small-step integration of dq/dt = w q / 2 against orientation_at, with side spin so that the
// axis turns.
TEST(Motion, OrientationFollowsTheSpin) {
    Scene scene = empty_scene();
    add_ball(scene, "a", 0, 0, 1.5, 0.4, Vec3(-60.0, 20.0, 35.0));
    const Record record = run_verified(scene);
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
    const double end = 4.0, h = 1e-5;
    for (int i = 0; i < static_cast<int>(std::lround(end / h)); ++i) {
        const Vec3 turn = record.state_at(0, (i + 0.5) * h).spin * h;
        const double angle = turn.norm();
        if (angle > 0.0) q = Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) * q;
    }
    const Eigen::Quaterniond got = record.orientation_at(0, end);
    EXPECT_NEAR(got.norm(), 1.0, 1e-14);
    EXPECT_LT(q.angularDistance(got), 1e-6);
}

// Straight rolling has a fixed axis; the angle is the distance over R.
TEST(Motion, RollingTurnsByDistanceOverRadius) {
    Scene scene = empty_scene();
    add_ball(scene, "a", 0, 0, 1.0, 0.0, rolling_spin(1.0, 0.0, scene.balls.R));
    const Record record = run_verified(scene);
    const double angle = record.state_at(0, 0.7).position.x() / scene.balls.R;
    const Eigen::Quaterniond expected(Eigen::AngleAxisd(angle, Vec3(0, 1, 0)));
    EXPECT_LT(expected.angularDistance(record.orientation_at(0, 0.7)), 1e-12);
}

}  // namespace
}  // namespace carom
