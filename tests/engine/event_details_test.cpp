// Place, speed and strength of events: against closed forms, and for every event of every scene.
#include "carom/engine/event_details.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/engine_cases.h"
#include "support/files.h"

namespace carom::test {
namespace {

constexpr double kOneDegree = std::numbers::pi / 180.0;

/// Equal balls without friction that lose nothing, on an endless cloth.
Scene ideal() {
    Scene scene = instant_scene();
    scene.balls.mu_s = scene.balls.mu_r = scene.balls.mu_sp = scene.balls.mu_b = 0.0;
    scene.balls.e_b = 1.0;
    scene.physics.ball_ball = ball_ball_model("elastic");
    return scene;
}

std::size_t index_of_first(const Record& record, EventType type) {
    for (std::size_t i = 0; i < record.events.size(); ++i)
        if (record.events[i].type == type) return i;
    ADD_FAILURE() << "there is no " << name(type);
    return 0;
}

TEST(EventDetails, AHalfBallHitHasItsCutAngleSpeedAndImpulse) {
    for (const double hit : {0.0, 0.25, 0.5, 0.75}) {
        Scene scene = ideal();
        const double R = scene.balls.R, speed = 1.7;
        add_ball(scene, "cue", -0.5, 0.0, speed);
        add_ball(scene, "1", 0.0, 2.0 * R * hit);
        scene.stop.events = 1;
        const Record record = run_verified(scene);
        const std::size_t i = index_of_first(record, EventType::kBallBall);
        const EventDetails d = details_of(record, i);
        const double cut = std::asin(hit);
        EXPECT_NEAR(d.cut, cut, 1e-9);
        EXPECT_NEAR(d.closing, speed * std::cos(cut), 1e-12);
        EXPECT_NEAR(d.impulse, scene.balls.m * speed * std::cos(cut), 1e-12);
        EXPECT_NEAR(d.lost, 0.0, 1e-13);
        EXPECT_TRUE(std::isnan(d.diamond));
        // Equal balls touch in the middle, on the line of centres.
        const Vec3 middle = 0.5 * (d.balls[0].after.position + d.balls[1].after.position);
        EXPECT_LT((d.point - middle).norm(), 1e-12);
        EXPECT_NEAR(d.normal.x(), -std::cos(cut), 1e-9);
    }
}

TEST(EventDetails, ABankReportsDiamondNoseAndLostEnergy) {
    Scene scene = ideal();
    scene.table = box(1.0, 2.0, 0.036);
    scene.balls.e_c = 0.5;
    scene.balls.f_c = 0.0;
    add_ball(scene, "cue", 0.5, 0.5, 1.0, 1.0);
    scene.stop.events = 1;
    const Record record = run_verified(scene);
    const EventDetails d = details_of(record, index_of_first(record, EventType::kBallCushion));
    const double reach = 0.5 - (1.0 - d.balls[0].after.position.x());
    EXPECT_NEAR(d.diamond, (0.5 + reach) / 2.0 * 8.0, 1e-12);
    EXPECT_NEAR(d.point.x(), 1.0, 1e-15);
    EXPECT_NEAR(d.point.z(), 0.036, 1e-15);
    EXPECT_NEAR(d.cut, 45.0 * kOneDegree, 1e-12);
    EXPECT_NEAR(d.closing, 1.0, 1e-12);
    EXPECT_GT(d.lost, 0.0);
    EXPECT_EQ(met_name(record, record.events[index_of_first(record, EventType::kBallCushion)]), "right");
}

TEST(EventDetails, EveryEventOfEverySceneJoinsItsStates) {
    for (const auto& path : toml_files(CAROM_SOURCE_DIR "/scenes")) {
        SCOPED_TRACE(path);
        const Record record = simulate(plan_of(read_scene(path.string())));
        std::vector<double> row(event_columns().size());
        for (std::size_t i = 0; i < record.events.size(); ++i) {
            SCOPED_TRACE(i);
            const Event& event = record.events[i];
            const EventDetails d = details_of(record, i);
            const bool falls = event.type == EventType::kBallPocket;
            for (const BallAtEvent& ball : d.balls) {
                EXPECT_TRUE(ball.before.velocity.allFinite() && ball.after.velocity.allFinite());
                const double jump = falls ? 0.0 : (ball.before.position - ball.after.position).norm();
                EXPECT_LT(jump, 1e-9);
            }
            if (kind(event.type).phase == EventPhase::kImpact && !falls) {
                EXPECT_NEAR(d.normal.norm(), 1.0, 1e-12);
                EXPECT_FALSE(d.lost < -1e-9) << d.lost;
                // A break's clusters begin at closed gaps, and the pair that met may be parting.
                EXPECT_FALSE(event.type != EventType::kBallCluster && d.closing < -1e-9) << d.closing;
            }
            event_row(record, i, row);
            EXPECT_EQ(row[0], d.balls[0].after.position.x());
            EXPECT_TRUE(std::isnan(row.back()) == std::isnan(d.diamond));
        }
    }
}

TEST(EventDetails, SimultaneousEventsAreDistinguished) {
    // Two balls reach a third one from both sides at the same time.
    Scene scene = ideal();
    add_ball(scene, "left", -0.5, 0.0, 1.0);
    add_ball(scene, "middle", 0.0, 0.0);
    add_ball(scene, "right", 0.5, 0.0, -1.0);
    scene.physics.clusters = ClusterModel::kSequential;
    const Record record = run_verified(scene);
    ASSERT_GE(record.events.size(), 2u);
    const EventDetails first = details_of(record, 0), second = details_of(record, 1);
    EXPECT_EQ(record.events[0].time, record.events[1].time);
    EXPECT_NEAR(first.closing, 1.0, 1e-12);
    // The first impact has set the middle ball in motion.
    EXPECT_NEAR(second.closing, 2.0, 1e-12);
}

}  // namespace
}  // namespace carom::test
