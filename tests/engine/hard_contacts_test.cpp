// Hard cases of simultaneous contacts, through the engine: H1 to H3, H6 of tests/README.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "carom/engine/ball_ball.h"

#include "scene/rack.h"
#include "support/hard_scenes.h"

namespace carom {
namespace {

using namespace test;

// Head-on break on the axis x = 0, and the same mirrored about it.
Scene axis_break(double gap, double cue_x, double speed) {
    Scene scene = empty_scene();
    Rack rack;
    rack.gap = gap;
    for (const RackedBall& b : make_rack(rack, spot_at(Vec2(0.0, 0.0)), scene.balls.R))
        add_ball(scene, b.id, b.position.x(), b.position.y());
    add_ball(scene, "cue", cue_x, -1.0, 0.0, speed);
    return scene;
}

// H1: left and right agree, and the cue ball stays on the axis.
TEST(HardContacts, HeadOnBreakOnTheAxis) {
    for (const double gap : {0.0, 1e-12, 1e-6, 1e-4}) {
        SCOPED_TRACE(gap);
        const Scene scene = axis_break(gap, 0.0, 8.0);
        const Record record = run_verified(scene);
        const std::size_t cue = scene.ball.size() - 1;
        const Event* wave = first(record, EventType::kBallCluster);
        if (wave == nullptr) wave = first(record, EventType::kBallBall);
        ASSERT_NE(wave, nullptr);
        double worst = 0.0;
        for (std::size_t i = 0; i < cue; ++i) {
            for (std::size_t j = 0; j < cue; ++j) {
                if (scene.ball[j].position.x() != -scene.ball[i].position.x() ||
                    scene.ball[j].position.y() != scene.ball[i].position.y())
                    continue;
                const Vec3 p = record.state_at(static_cast<int>(i), wave->time).velocity,
                           q = record.state_at(static_cast<int>(j), wave->time).velocity;
                worst = std::max({worst, std::abs(p.x() + q.x()), std::abs(p.y() - q.y())});
            }
        }
        report("H1 asymmetry", worst);
        EXPECT_EQ(worst, 0.0);
        for (const double t : {0.2, 0.5, 1.0}) {
            const double x = std::abs(record.state_at(static_cast<int>(cue), t).position.x());
            report("H1 cue ball off the axis", x);
            EXPECT_EQ(x, 0.0) << t;
        }
        EXPECT_EQ(simulate(plan_of(scene)).hash(), record.hash()) << "same scene, same bits";
    }
}

// H1: mirroring an off-axis break mirrors its result, to rounding: a ball on the rack's axis adds the forces
// of its two sides one after the other.
TEST(HardContacts, MirroredBreak) {
    for (const double gap : {0.0, 1e-4}) {
        const Scene scene = axis_break(gap, 0.0123, 8.0);
        Scene mirrored = scene;
        for (BallStart& b : mirrored.ball) b.position.x() = -b.position.x();
        const Record one = run_verified(scene), two = run_verified(mirrored);
        ASSERT_GE(one.events.size(), 20u);
        const double t = one.events[std::min<std::size_t>(49, one.events.size() - 1)].time;
        for (int i = 0; i < 16; ++i) {
            const Vec3 p = one.state_at(i, t).position, q = two.state_at(i, t).position;
            EXPECT_NEAR(p.x(), -q.x(), 1e-9) << i;
            EXPECT_NEAR(p.y(), q.y(), 1e-9) << i;
        }
    }
}

// H2 in table coordinates.
TEST(HardContacts, ThreeBallsInTableCoordinates) {
    const double e[] = {1.0, 0.95, 0.9, 0.5};
    for (const ClusterModel model : {ClusterModel::kCompliant, ClusterModel::kRigid}) {
        for (const double restitution : e) {
            SCOPED_TRACE(std::string(name(model)) + " e = " + std::to_string(restitution));
            Scene scene = empty_scene();
            scene.balls.e_b = restitution;
            scene.balls.mu_b = scene.balls.mu_s = scene.balls.mu_r = scene.balls.mu_sp = 0.0;
            scene.physics.ball_ball = ball_ball_model("inelastic");
            scene.physics.clusters = model;
            scene.stop.events = 1;
            const double R = scene.balls.R, x = 0.635, y = 1.486;
            add_ball(scene, "a", x - R, y);
            add_ball(scene, "b", x + R, y);
            // The values assume balls that do not move during the contact, so the speed is low.
            const double V = model == ClusterModel::kCompliant ? 0x1p-17 : 1.0;
            add_ball(scene, "cue", x, y - 0.3, 0.0, V);
            const Record record = run_verified(scene);
            ASSERT_EQ(record.events.size(), 1u);
            ASSERT_EQ(record.events[0].type, EventType::kBallCluster);
            const double tolerance = model == ClusterModel::kRigid ? 1e-12 : 1e-6;
            // The motion after a cluster that lasts is also the final one.
            const auto after = [&](std::size_t ball) {
                return Vec3(record.tracks[ball].segments.back().v / V);
            };
            const Vec3 a = after(0), b = after(1), cue = after(2);
            EXPECT_NEAR(cue.y(), 1.0 - 0.6 * (1.0 + restitution), tolerance);
            EXPECT_NEAR(a.norm(), 0.2 * std::sqrt(3.0) * (1.0 + restitution), tolerance);
            EXPECT_NEAR(a.x(), -b.x(), 1e-12);
            EXPECT_NEAR(a.y(), b.y(), 1e-12);
            EXPECT_NEAR(cue.x(), 0.0, 1e-12);
            report("H2 error of the cue ball", std::abs(cue.y() - 1.0 + 0.6 * (1.0 + restitution)));
        }
    }
}

// H3: a touching line is one cluster event, in order of speed, momentum kept.
TEST(HardContacts, CradleIsOneEvent) {
    for (int n = 2; n <= 15; ++n) {
        for (const double restitution : {1.0, 0.95, 0.9, 0.5}) {
            SCOPED_TRACE(std::to_string(n) + " object balls, e = " + std::to_string(restitution));
            Scene scene = frictionless();
            scene.balls.e_b = restitution;
            scene.physics.ball_ball = ball_ball_model("inelastic");
            scene.stop.time = 2.0;
            const double R = scene.balls.R;
            add_ball(scene, "cue", 0.0, -0.5, 0.0, 0.7);
            for (int k = 0; k < n; ++k) add_ball(scene, std::to_string(k), 0.0, 2.0 * k * R);
            const Record record = run_verified(scene);
            ASSERT_FALSE(record.events.empty());
            EXPECT_EQ(record.events[0].type, EventType::kBallCluster);
            EXPECT_EQ(record.clusters[0].balls.size(), static_cast<std::size_t>(n + 1));
            EXPECT_LE(record.events.size(), static_cast<std::size_t>(n * (n + 1) / 2 + 2 * n));
            double sum = 0.0, last = -1.0;
            for (int k = 0; k <= n; ++k) {
                const double v = record.state_at(k, 2.0).velocity.y();
                EXPECT_GE(v, last - 1e-12) << "ball " << k;
                last = v;
                sum += v;
            }
            report("H3 momentum", std::abs(sum - 0.7));
            EXPECT_NEAR(sum, 0.7, 1e-14 * n);
        }
    }
}

// H6: two balls squeeze a resting one, and a cue ball meets a line of three from its side.
TEST(HardContacts, SqueezedBall) {
    for (const ClusterModel model :
         {ClusterModel::kCompliant, ClusterModel::kSequential, ClusterModel::kRigid}) {
        SCOPED_TRACE(name(model));
        Scene scene = frictionless();
        scene.balls.e_b = 0.95;
        scene.physics.ball_ball = ball_ball_model("inelastic");
        scene.physics.clusters = model;
        scene.stop.time = 0.1;
        const double R = scene.balls.R;
        add_ball(scene, "b", -2.0 * R, 0.0, 1.0, 0.0);
        add_ball(scene, "a", 0.0, 0.0);
        add_ball(scene, "c", 2.0 * R, 0.0, -1.0, 0.0);
        const Record record = run_verified(scene);
        const Vec3 b = record.state_at(0, 0.1).velocity, a = record.state_at(1, 0.1).velocity,
                   c = record.state_at(2, 0.1).velocity;
        if (model == ClusterModel::kSequential)
            continue;  // pair by pair: a convention; neither order is symmetric
        EXPECT_LE(std::abs(a.x()), 1e-15);
        EXPECT_EQ(b.x(), -c.x());
        EXPECT_NEAR(b.x(), -0.95, 1e-6);
    }
    Scene line = frictionless();
    line.balls.e_b = 0.95;
    line.physics.ball_ball = ball_ball_model("inelastic");
    line.stop.events = 1;
    const double R = line.balls.R, expected[] = {-.044632, -.005973, .124616, .925989};
    add_ball(line, "cue", 0.0, -0.3, 0.0, 1.0);
    for (int k = 0; k < 3; ++k) add_ball(line, std::to_string(k), 0.0, 2.0 * k * R);
    const Record record = run_verified(line);
    for (int k = 0; k < 4; ++k)
        EXPECT_NEAR(record.tracks[static_cast<std::size_t>(k)].segments.back().v.y(), expected[k], 1e-6) << k;
}

}  // namespace
}  // namespace carom
