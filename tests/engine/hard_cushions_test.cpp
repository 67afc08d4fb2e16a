// Cushions at the edge of what a scene may say: extreme spins, and noses that a ball does not leave at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/tolerances.h"
#include "reference/random_impacts.h"
#include "support/hard_scenes.h"

namespace carom::test {
namespace {

/// How deep a ball is in a cushion of the table, at the worst of many times.
double deepest(const Record& record, const Plan& plan) {
    double depth = 0.0;
    constexpr int kTimes = 2000;
    for (int k = 0; k <= kTimes; ++k) {
        for (std::size_t i = 0; i < record.tracks.size(); ++i) {
            const BallState s = record.state_at(static_cast<int>(i), record.duration * k / kTimes);
            for (const CushionLine& c : plan.geometry.cushions) {
                const Vec2 offset = planar(s.position) - c.from;
                const double foot = dot(c.direction, offset);
                if (foot < 0.0 || foot > c.length) continue;
                depth = std::max(depth,
                                 record.size(static_cast<int>(i)).R - std::abs(cross(c.direction, offset)));
            }
        }
    }
    return depth;
}

// A ball an ulp from a cushion, which its spin drives into it: the touch is slower than the rounding of its surface's speed.
TEST(ExtremeSpin, DrivesNoBallThroughACushion) {
    Scene scene = empty_scene();
    scene.table.cushions = {{"c", {-1.0, 0.0}, {1.0, 0.0}, 0.036576}};
    scene.stop.time = 0.5;
    add_ball(scene, "cue", 0.0, 0.028575000000000007, 0.0, 0.0, Vec3(100.0, 0.0, 1e9));
    const Plan plan = plan_of(scene);
    const Record record = run_verified(scene);
    EXPECT_LE(deepest(record, plan), kTouchTolerance);
}

// The same at any gap and any spin.
TEST(ExtremeSpin, DrivesNoBallThroughACushionFromAnyGap) {
    reference::Generator random(11);
    double worst = 0.0;
    for (int k = 0; k < 3000; ++k) {
        Scene scene = empty_scene();
        scene.balls.mu_s = std::pow(10.0, random.uniform(-3.5, 0.0));
        scene.balls.mu_r = 0.1 * scene.balls.mu_s;
        scene.table.cushions = {{"c", {-1.0, 0.0}, {1.0, 0.0}, 0.036576}};
        scene.stop.time = 0.3;
        const double gap = random.uniform(0.0, 1.0) < 0.3 ? 0.0 : std::pow(10.0, random.uniform(-17.0, -6.0));
        const double side = std::pow(10.0, random.uniform(0.0, 9.0)),
                     top = std::pow(10.0, random.uniform(0.0, 9.0));
        add_ball(scene, "cue", 0.0, scene.balls.R + gap, 0.0, 0.0, Vec3(top, 0.0, side));
        const Plan plan = plan_of(scene);
        const Record record = run_verified(scene);
        worst = std::max(worst, deepest(record, plan));
        ASSERT_LE(worst, kTouchTolerance)
            << "gap " << gap << " side " << side << " top " << top << " mu_s " << scene.balls.mu_s;
    }
    report("depth in a cushion, 3000 spins to 1e9 rad/s [m]", worst);
}

// Four balls on a slow cloth, one of them at 170 km/s: one ended 6 mm deep in a cushion.
TEST(ExtremeSpin, KeepsABoxShut) {
    Scene scene = empty_scene();
    BallParams& b = scene.balls;
    b.R = 0.010486317455603019;
    b.m = 0.040036937939296718;
    b.mu_s = 0.00048237479229730213;
    b.mu_r = 8.4847671627163968e-05;
    b.mu_sp = 0.003718071060703018;
    b.mu_b = 0.0;
    b.e_b = 0.10981392751241859;
    b.e_c = 0.041766679624904324;
    b.f_c = 0.35615286252405348;
    scene.table = box(0.83890539644824158, 0.62917904733618113, 0.015506059927491959);
    scene.physics.gravity = 5.8479066262446375;
    scene.physics.ball_ball = ball_ball_model("mathavan");
    scene.physics.cushion = &kSmooth;
    scene.physics.clusters = ClusterModel::kRigid;
    add_ball(scene, "b0", 0.1677810792896483, 0.010486317455603019);
    add_ball(scene, "b1", 0.18875371420085435, 0.010486317455603019);
    add_ball(scene, "b2", 0.17826739674525133, 0.028649152073003864);
    add_ball(scene, "b3", 0.021360729184595934, 0.03558110337434521, 165105.6492808183, -38358.75154285317,
             Vec3(-13414601.412809752, -12828074.038416866, 2227324.2239214168));
    const Plan plan = plan_of(scene);
    EXPECT_LE(deepest(run_verified(scene), plan), kTouchTolerance);
}

Scene high_nose(double height, double e_c, double f_c) {
    Scene scene = empty_scene();
    scene.table.cushions = {{"c", {0.0, 0.0}, {2.0, 0.0}, height * scene.balls.R}};
    scene.balls.e_c = e_c;
    scene.balls.f_c = f_c;
    add_ball(scene, "cue", 1.0, 0.1, 0.5, -1.0);
    return scene;
}

// han_2005 leaves a ball that still closes where e_c < 1 / c^2 - 1. It was met again at the same instant, 2 to 15 times.
TEST(HighNose, IsOneEvent) {
    for (const double height : {1.28, 1.45, 1.55, 1.6, 1.8, 1.99}) {
        for (const double e_c : {0.0, 0.05, 0.25, 0.5}) {
            for (const double f_c : {0.0, 0.2}) {
                const Record record = run_verified(high_nose(height, e_c, f_c));
                const Event* hit = first(record, EventType::kBallCushion);
                ASSERT_TRUE(hit != nullptr);
                int at_once = 0;
                for (const Event& e : record.events) at_once += e.time == hit->time ? 1 : 0;
                EXPECT_EQ(at_once, 1) << height << " R, e_c " << e_c << ", f_c " << f_c;
                const double away = record.state_at(0, hit->time).velocity.y();
                EXPECT_GE(away, -1e-14) << height << " R, e_c " << e_c << ", f_c " << f_c;
                EXPECT_LE(away, 1.0);
            }
        }
    }
}

}  // namespace
}  // namespace carom::test
