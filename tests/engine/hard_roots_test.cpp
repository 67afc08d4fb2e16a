// Hard cases of detection and geometry, through the engine: H10 to H21 of tests/README.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/cushion.h"
#include "carom/engine/math.h"
#include "contact/detect.h"
#include "contact/roots.h"
#include "support/hard_scenes.h"

namespace carom {
namespace {

using namespace test;

// H10: a rolling ball grazes: the sign of h decides the hit, the gap holds to ulps.
TEST(HardRoots, Graze) {
    const double depths[] = {1e-4,  1e-5,  1e-6,  1e-7, 1e-8,   1e-9,   1e-10,  1e-11,  1e-12,  1e-13,
                             1e-14, 1e-15, 1e-16, 0.0,  -1e-16, -1e-15, -1e-14, -1e-12, -1e-10, -1e-8};
    double worst_gap = 0.0, worst_time = 0.0;
    for (const double v : {1.0, 5.0, 0.5}) {
        for (const double h : depths) {
            SCOPED_TRACE("v = " + std::to_string(v) + ", h = " + std::to_string(h * 1e12) + "e-12");
            Scene scene = instant_scene();
            const double R = scene.balls.R, x = 2.0 * R - h;
            add_ball(scene, "cue", x, -1.0, 0.0, v, rolling_spin(0.0, v, R));
            add_ball(scene, "object", 0.0, 0.0);
            scene.stop.events = 1;
            const Record record = run_verified(scene);
            ASSERT_EQ(record.events.size(), 1u);
            const bool hit = record.events[0].type == EventType::kBallBall;
            const double depth = 2.0 * R - x;  // as rounded
            if (std::abs(depth) > 4e-16) {
                EXPECT_EQ(hit, depth > 0.0);
            }
            if (!hit) continue;
            const double t = record.events[0].time;
            const Vec3 p = record.state_at(0, t).position, q = record.state_at(1, t).position;
            const double gap = std::hypot(p.x() - q.x(), p.y() - q.y()) - 2.0 * R;
            EXPECT_LE(std::abs(gap), 1e-14);
            worst_gap = std::max(worst_gap, std::abs(gap));
            const double y = 1.0 - std::sqrt(std::max(0.0, depth * (4.0 * R - depth))), a = 0.01 * 9.81;
            const double want = 2.0 * y / (v + std::sqrt(v * v - 2.0 * a * y));
            // The time is only as precise as the gap over the closing speed.
            const double closing = std::max(1e-9, v * std::sqrt(std::max(0.0, depth) / R));
            EXPECT_NEAR(t, want, 1e-15 / closing + 1e-14);
            worst_time = std::max(worst_time, std::abs(t - want));
        }
    }
    report("H10 gap", worst_gap);
    report("H10 time", worst_time);
}

// H11: both roll with the same deceleration, so the quartic reduces to a line.
TEST(HardRoots, CatchUp) {
    for (const double dv : {1e-9, 1e-12, 1e-15}) {
        SCOPED_TRACE(dv);
        Scene scene = empty_scene();
        const double R = scene.balls.R, v = 1.0 + dv;
        const double ahead = 2.0 * R + 1e-12, gap = ahead - 2.0 * R;
        add_ball(scene, "a", 0.0, 0.0, 0.0, v, rolling_spin(0.0, v, R));
        add_ball(scene, "b", 0.0, ahead, 0.0, 1.0, rolling_spin(0.0, 1.0, R));
        const Record record = run_verified(scene);
        const Event* hit = first(record, EventType::kBallBall);
        const double relative = v - 1.0;
        if (dv < 1e-14) continue;  // the closing speed is 5 ulp of the speeds; either result is right
        ASSERT_NE(hit, nullptr);
        const double error = std::abs(hit->time * relative / gap - 1.0);
        report("H11 relative error of the time, in ulp of v / dv", error * relative / 2.2e-16);
        EXPECT_LE(error, 8.0 * 2.2e-16 / relative);
        EXPECT_LE(record.events.size(), 12u);
    }
}

// H12: scaling length and time by powers of two changes only exponents.
TEST(HardRoots, ScalesBitwise) {
    const auto scaled = [](double L, double T) {
        Scene scene = empty_scene();
        scene.physics.gravity *= L / (T * T);
        scene.balls.R *= L;
        scene.physics.clusters = ClusterModel::kSequential;
        const double V = L / T;
        add_ball(scene, "a", Vec3(0.0, 0.0, 0.028575) * L, Vec3(0.3, 3.0, 0.0) * V,
                 Vec3(20.0, -50.0, 10.0) / T);
        add_ball(scene, "b", Vec3(0.05, 0.5, 0.028575) * L, Vec3(0.0, 0.5, 0.0) * V);
        add_ball(scene, "c", Vec3(0.1, 0.9, 0.028575) * L, Vec3(-0.2, -2.0, 0.0) * V,
                 Vec3(0.0, 40.0, 0.0) / T);
        return run_verified(scene);
    };
    const Record one = scaled(1.0, 1.0);
    EXPECT_GE(count(one, EventType::kBallBall), 2);
    for (const auto& [L, T] : {std::pair{1024.0, 1.0}, {1.0, 0x1p-10}, {0x1p-3, 0x1p-5}}) {
        const Record other = scaled(L, T);
        ASSERT_EQ(other.events.size(), one.events.size());
        for (std::size_t i = 0; i < one.events.size(); ++i) {
            EXPECT_EQ(other.events[i].type, one.events[i].type);
            EXPECT_EQ(other.events[i].time, one.events[i].time * T) << i;
            const int a = one.events[i].a;
            EXPECT_EQ(other.state_at(a, other.events[i].time).position,
                      one.state_at(a, one.events[i].time).position * L)
                << i;
        }
    }
    // The solver never divides by a tiny leading coefficient.
    const Path slow{{0.0, 0.0}, {0.0, 40.0}, {0.0, -1e-11}, 1e3, true, true},
        rest{{0.0, 2 * 0.0286 + 1e-12}, {0, 0}, {0, 0}, kNever, true, false};
    const double t = time_to_ball(slow, rest, 2 * 0.0286);
    EXPECT_NEAR(t, (rest.r.y() - 2 * 0.0286) / 40.0, 1e-18);
}

// H13: a ball rolls just far enough to touch.
TEST(HardRoots, StopsAtContact) {
    for (const double factor : {1.0, 1.0 + 1e-12, 1.0 - 1e-12}) {
        Scene scene = empty_scene();
        const double R = scene.balls.R, v = factor * std::sqrt(2.0 * 0.01 * 9.81 * 0.5);
        add_ball(scene, "a", 0.0, 0.0, v, 0.0, rolling_spin(v, 0.0, R));
        add_ball(scene, "b", 2.0 * R + 0.5, 0.0);
        const Record record = run_verified(scene);
        EXPECT_LE(record.events.size(), 6u);
        const double gap = record.state_at(1, record.duration).position.x() -
                           record.state_at(0, record.duration).position.x() - 2.0 * R;
        report("H13 final gap", gap);
        EXPECT_GE(gap, -1e-15);
        EXPECT_LE(gap, 1e-9);
        if (const Event* hit = first(record, EventType::kBallBall)) {
            EXPECT_LE(record.state_at(1, hit->time).velocity.norm(), factor > 1.0 ? 5e-7 : 1e-8);
        } else {
            EXPECT_LE(factor, 1.0);
        }
    }
}

// H14: stun turns into roll at the instant of the hit.
TEST(HardRoots, SlideRollAtContact) {
    const double g = 9.81, mu = 0.2, d = 12.0 / (49.0 * mu * g);
    std::vector<Vec3> after;
    for (const double shift : {0.0, 1e-15, -1e-15}) {
        Scene scene = empty_scene();
        const double R = scene.balls.R;
        add_ball(scene, "a", 0.0, 0.0, 1.0, 0.0);
        add_ball(scene, "b", d + 2.0 * R + shift, 0.0);
        const Record record = run_verified(scene);
        const Event* hit = first(record, EventType::kBallBall);
        ASSERT_NE(hit, nullptr);
        EXPECT_NEAR(hit->time, 2.0 / (7.0 * mu * g), 1e-14);
        after.push_back(record.state_at(1, hit->time).velocity);
        const double v_hit = after.back().x() + record.state_at(0, hit->time).velocity.x();
        EXPECT_NEAR(v_hit, 5.0 / 7.0, 1e-2) << "momentum up to the cloth's impulse";
    }
    for (const Vec3& v : after) {
        report("H14 difference of the orders", (v - after[0]).norm());
        EXPECT_LE((v - after[0]).norm(), 1e-13);
    }
}

// H15: events due at the start happen at the start.
TEST(HardRoots, EventsAtTheStart) {
    Scene scene = empty_scene();
    const double R = scene.balls.R;
    scene.table.pockets = {{"p1", {1.0, 1.0}, 0.06, 0.08}};
    add_ball(scene, "in the pocket", 1.01, 1.0);
    add_ball(scene, "closing", 0.0, 0.0, 1.0, 0.0);
    add_ball(scene, "touched", 2.0 * R - 5e-13, 0.0);
    add_ball(scene, "no spin, no speed", -1.0, 0.0, 0.0, 0.0);
    const Record record = run_verified(scene);
    ASSERT_GE(record.events.size(), 2u);
    EXPECT_EQ(record.events[0].type, EventType::kBallEdge);
    EXPECT_EQ(record.events[0].time, 0.0);
    EXPECT_EQ(record.events[1].type, EventType::kBallBall);
    EXPECT_EQ(record.events[1].time, 0.0);
    EXPECT_EQ(record.state_at(3, 0.0).state, MotionState::kStationary);
}

// Two touching balls at rest have accelerations of 2.6e-7 m/s^2, almost along each other, that close the
// contact at 2.7e-10 m/s^2; one ball's spin rounds speeds to 3e-14 m/s.
TEST(HardRoots, SlowTouch) {
    const double R = 0.007997277000662361;
    const Path a{{0.0, 0.006429872458811686},
                 {0.0, 0.0},
                 {-1.180691990260985e-07, 6.05358751840543e-08},
                 88.0,
                 true,
                 true,
                 4.7e-5},
        b{{0.007997277000662363, 0.02028156254616094},
          {0.0, 0.0},
          {1.11313204971654e-07, -7.22100986144071e-08},
          1e7,
          true,
          true,
          15.4};
    const double t = time_to_ball(a, b, 2.0 * R);
    EXPECT_GT(t, 1e-4);
    EXPECT_LT(t, 1e-3);
    // The contact opens if they point the other way.
    Path from = b;
    from.a = -3.0 * a.a;
    EXPECT_EQ(time_to_ball(Path{a.r, a.v, -a.a, a.horizon, true, true, a.surface}, from, 2.0 * R), kNever);
}

// H16: the end of a cushion has neither a gap nor a second normal.
TEST(HardRoots, CushionEnd) {
    for (const bool joined : {false, true}) {
        std::vector<Vec3> after;
        for (const double s : {-1e-16, 0.0, 1e-16, 2.3e-16, -2.3e-16}) {
            Scene scene = frictionless();
            scene.table.cushions = {{"c1", {0.0, 0.0}, {1.0, 0.0}, 0.036576}};
            if (joined) scene.table.cushions.push_back({"c2", {1.0, 0.0}, {2.0, 0.0}, 0.036576});
            add_ball(scene, "a", 1.0 + s, 0.5, 0.0, -1.0);
            scene.stop.time = 1.0;
            const Record record = run_verified(scene);
            EXPECT_EQ(count(record, EventType::kBallCushion), 1) << s;
            after.push_back(record.state_at(0, 1.0).velocity);
            EXPECT_NEAR(after.back().y(), 1.0, 1e-13);
            report("H16 difference across the end", (after.back() - after[0]).norm());
            EXPECT_LE((after.back() - after[0]).norm(), 1e-13) << s;
        }
    }
}

// H17: both cushions of a corner at once.
TEST(HardRoots, Corner) {
    Scene scene = empty_scene();
    scene.table = box(4.5, 4.5, 0.036576);
    scene.physics.cushion = &kSmooth;
    scene.balls.mu_s = scene.balls.mu_r = scene.balls.mu_sp = 0.0;
    const double e = scene.balls.e_c, v = 2.0 / std::sqrt(2.0);
    add_ball(scene, "a", 1.0, 1.0, -v, -v);
    scene.stop.time = 1.5;
    const Record record = run_verified(scene);
    EXPECT_EQ(record.events.size(), 2u);
    const Vec3 after = record.state_at(0, 1.5).velocity;
    report("H17 error", std::max(std::abs(after.x() - e * v), std::abs(after.y() - e * v)));
    EXPECT_NEAR(after.x(), e * v, 1e-14);
    EXPECT_NEAR(after.y(), e * v, 1e-14);
}

// H18: between two jaws converging at 20 degrees, bounces are finite.
TEST(HardRoots, JawRattle) {
    const SinCos ten = sin_cos_deg(10.0);
    for (const double e : {1.0, 0.85}) {
        for (const bool friction : {false, true}) {
            Scene scene = friction ? empty_scene() : frictionless();
            scene.balls.e_c = e;
            const double L = 4.0;
            scene.table.cushions = {{"l", {0.0, 0.0}, {-L * ten.sin, L * ten.cos}, 0.036576},
                                    {"r", {L * ten.sin, L * ten.cos}, {0.0, 0.0}, 0.036576}};
            add_ball(scene, "a", 1e-3, 3.0, 0.0, -2.0,
                     friction ? rolling_spin(0.0, -2.0, scene.balls.R) : Vec3::Zero());
            scene.stop.time = 3.0;
            const Record record = run_verified(scene);
            const int bounces = count(record, EventType::kBallCushion);
            report("H18 bounces", bounces);
            if (!friction && e == 1.0) {
                EXPECT_LE(bounces, 9) << "ceil(pi / 20 degrees)";
            }
            EXPECT_GE(bounces, 5);
            EXPECT_LE(bounces, 60);
        }
    }
}

// H19: on the lip of a pocket.
TEST(HardRoots, PocketLip) {
    const double r = 0.0625;  // exact
    const auto pocketed = [&](double x, double vx, double vy) {
        Scene scene = empty_scene();
        scene.table.pockets = {{"p1", {0.0, 0.0}, r, 0.08}};
        add_ball(scene, "a", x, 0.0, vx, vy, rolling_spin(vx, vy, scene.balls.R));
        return count(run_verified(scene), EventType::kBallPocket);
    };
    EXPECT_EQ(pocketed(r, 0.0, 0.0), 0) << "on the circle at rest: stays";
    EXPECT_EQ(pocketed(r, 0.0, 0.5), 0) << "tangent: stays out";
    EXPECT_EQ(pocketed(std::nextafter(r, 0.0), 0.0, 0.0), 1) << "inside by an ulp";
    EXPECT_EQ(pocketed(r, -0.1, 0.0), 1);
}

// H20: a ball that meets a pocket and a cushion, or two pockets, at one instant.
TEST(HardRoots, Ties) {
    for (const bool reversed : {false, true}) {
        Scene scene = frictionless();
        scene.physics.pocket = PocketModel::kAtOnce;
        const double R = scene.balls.R;
        scene.table.cushions = {{"c", {-1.0, 0.0}, {1.0, 0.0}, 0.036576}};
        std::vector<Pocket> pockets{{"left", {-0.25, 0.5 + R}, 0.25, 0.08},
                                    {"right", {0.25, 0.5 + R}, 0.25, 0.08}};
        add_ball(scene, "a", 0.0, 1.0 + R, 0.0, -1.0);
        // Its path is tangent to neither: it enters both circles at the height of their common point.
        pockets[0].radius = pockets[1].radius = 0.3125;
        if (reversed) std::swap(pockets[0], pockets[1]);
        scene.table.pockets = pockets;
        const Record record = run_verified(scene);
        ASSERT_EQ(count(record, EventType::kBallPocket), 1);
        EXPECT_EQ(record.table.pockets[first(record, EventType::kBallPocket)->b].id, "left")
            << "by place, not by number";
        // Pocket before cushion.
        Scene tie = frictionless();
        tie.physics.pocket = PocketModel::kAtOnce;
        tie.table.cushions = scene.table.cushions;
        tie.table.pockets = {{"p", {0.0, R - 0.25}, 0.25, 0.08}};
        add_ball(tie, "a", 0.0, 1.0 + R, 0.0, -1.0);
        const Record both = run_verified(tie);
        EXPECT_EQ(both.events[0].type, EventType::kBallPocket);
        EXPECT_EQ(both.events.size(), 1u);
    }
}

// H21: a slow ball still rolls and stops.
TEST(HardRoots, SlowBall) {
    Scene scene = empty_scene();
    add_ball(scene, "a", 1.0, 1.0, 1e-8, 0.0, rolling_spin(1e-8, 0.0, scene.balls.R));
    const Record record = run_verified(scene);
    ASSERT_EQ(record.events.size(), 1u);
    EXPECT_EQ(record.events[0].type, EventType::kRollStop);
    EXPECT_NEAR(record.events[0].time, 1e-8 / 0.0981, 1e-20);
    EXPECT_EQ(record.state_at(0, 1.0).state, MotionState::kStationary);
}

}  // namespace
}  // namespace carom
