// Groups of held balls: one small scene for each class of failure that the random scenes brought, and the
// solver of their forces.
#include <gtest/gtest.h>

#include "complementarity.h"
#include "support/random_scenes.h"

namespace carom {
namespace {

using namespace test;

Scene on_box() {
    Scene scene = empty_scene();
    scene.table = box(1.0, 2.0, 0.036576);
    scene.physics.cushion = CushionModel::kSmooth;
    return scene;
}

std::size_t segments_of(const Record& record) {
    std::size_t count = 0;
    for (const BallTrack& track : record.tracks) count += track.segments.size();
    return count;
}

// A ball at rest between a cushion and one that pushes it there and passes along: it leans on the cushion and
// stays, instead of starting, stopping and letting go again and again.
TEST(HeldGroups, SqueezedAgainstACushionStaysAtRest) {
    Scene scene = on_box();
    const double R = scene.balls.R;
    add_ball(scene, "squeezed", 1.0 - R, 1.0);
    add_ball(scene, "pusher", 1.0 - 3.0 * R, 1.0, 0.0, 0.024, Vec3(-0.9, 1.3, 0.0));
    const Record record = run_verified(scene);
    EXPECT_LE(record.events.size(), 40u);
    EXPECT_NEAR(record.state_at(0, 1e-3).position.x(), 1.0 - R, 1e-12);
}

// A ball pressed into the narrow wedge between a cushion and a ball, whose normals are nearly opposite.
TEST(HeldGroups, WedgeOfNearlyOppositeNormals) {
    for (const double tilt : {0.3, 0.03, 1e-3, 1e-5}) {
        Scene scene = on_box();
        const double R = scene.balls.R;
        const Vec2 n(std::sqrt(1.0 - tilt * tilt), tilt);
        add_ball(scene, "wedged", 1.0 - R, 1.0, 0.0, 0.0, Vec3(-200.0, 0.0, 0.0));
        add_ball(scene, "side", 1.0 - R - 2.0 * R * n.x(), 1.0 + 2.0 * R * n.y(), 0.0, 0.0,
                 Vec3(0.0, 200.0, 0.0));
        const Record record = run_verified(scene);
        EXPECT_EQ(record.stopped, StopReason::kAtRest) << tilt;
        EXPECT_LE(segments_of(record), 2000u) << tilt;
    }
}

// A line driven by spin, obliquely, against a cushion: the directions of its forces turn all the way. Every
// 2 ms took more than 10 000 segments.
TEST(HeldGroups, LongLineTakesFewIntervals) {
    Scene scene = on_box();
    scene.balls.mu_s = 0.05;
    const double R = scene.balls.R;
    for (int i = 0; i < 12; ++i)
        add_ball(scene, std::to_string(i), 1.0 - R - 2.0 * R * i, 1.0, 0.0, 0.0,
                 i == 11 ? Vec3(-150.0, 300.0, 0.0) : Vec3::Zero());
    const Record record = run_verified(scene);
    EXPECT_EQ(record.stopped, StopReason::kAtRest);
    EXPECT_LE(record.events.size(), 300u);
    EXPECT_LE(segments_of(record), 6000u);
}

// Plastic cushion: a ball driven into the wedge before another takes a bounce for each time its cushion takes
// the speed out again. The row has no end; its limit is the capture.
TEST(HeldGroups, RowOfBouncesInNoTimeEnds) {
    for (const double e_b : {0.5, 0.95, 1.0}) {
        Scene scene = on_box();
        scene.balls.e_c = 0.0;
        scene.balls.e_b = e_b;
        scene.physics.ball_ball = BallBallModel::kInelastic;
        const double R = scene.balls.R, tilt = 0.02;
        add_ball(scene, "in the wedge", 1.0 - R, 1.0);
        add_ball(scene, "driver", 1.0 - R - 2.0 * R * std::sqrt(1.0 - tilt * tilt), 1.0 - 2.0 * R * tilt, 1.0,
                 0.9);
        const Record record = run_verified(scene);
        EXPECT_EQ(record.stopped, StopReason::kAtRest) << e_b;
        EXPECT_LE(record.events.size(), 1000u) << e_b;
    }
}

// A pair begins to touch at 1e-12 m/s while a third ball is about to arrive at 1 m/s: the map of the cluster
// is scaled by the fast one. Scaled by the slow one it blew up.
TEST(HeldGroups, SlowTouchNextToAFastApproach) {
    Scene scene = empty_scene();
    const double R = scene.balls.R;
    add_ball(scene, "a", 0.0, 0.0, 1e-12, 0.0, rolling_spin(1e-12, 0.0, R));
    add_ball(scene, "b", 2.0 * R, 0.0);
    add_ball(scene, "c", 4.0 * R + 1e-7, 0.0, -1.0, 0.0, rolling_spin(-1.0, 0.0, R));
    const Record record = run_verified(scene);
    for (const double t : {1e-6, 1e-3, 0.1})
        for (int i = 0; i < 3; ++i) EXPECT_LE(record.state_at(i, t).velocity.norm(), 1.0 + 1e-9);
}

// A contact that rounding closes is held without an impact, and one without force stays without events.
TEST(HeldGroups, BallsThatRestTogetherStayTogether) {
    Scene scene = on_box();
    const double R = scene.balls.R;
    for (int i = 0; i < 4; ++i)
        add_ball(scene, std::to_string(i), 1.0 - R - 2.0 * R * i, 1.0, 0.0, 0.0,
                 i == 3 ? Vec3(0.0, 60.0, 0.0) : Vec3::Zero());
    const Record record = run_verified(scene);
    EXPECT_EQ(count(record, EventType::kBallBall) + count(record, EventType::kBallCluster), 0);
    EXPECT_LE(record.events.size(), 20u);
    for (int i = 0; i < 4; ++i)
        EXPECT_NEAR(record.state_at(i, record.duration).position.x(), 1.0 - R - 2.0 * R * i, 2e-12);
}

// Two cushions and a corner: into both at once, with and without spin, every restitution.
TEST(HeldGroups, CornerComesToRest) {
    for (const double e_c : {0.0, 0.5, 0.85, 1.0}) {
        for (const double spin : {0.0, 100.0}) {
            Scene scene = on_box();
            scene.balls.e_c = e_c;
            const double R = scene.balls.R;
            add_ball(scene, "a", 1.0 - R, 2.0 - R, 1.0, 1.0, Vec3(-spin, spin, 0.0));
            const Record record = run_verified(scene);
            EXPECT_EQ(record.stopped, StopReason::kAtRest) << e_c << " " << spin;
        }
    }
}

// z >= 0, w = A z + q >= 0, z w = 0 for A = G G^T, with up to twice as many contacts as directions.
TEST(Complementarity, RandomProblemsWithRedundantContacts) {
    test::SplitMix64 rng(1);
    for (int round = 0; round < 2000; ++round) {
        const std::size_t contacts = 1 + static_cast<std::size_t>(rng.uniform(0.0, 12.0)), ways = 6;
        std::vector<double> G(contacts * ways), drive(ways);
        for (double& x : G) x = rng.uniform(-1.0, 1.0);
        for (double& x : drive) x = rng.uniform(-1.0, 1.0);
        Complementarity problem(contacts);
        for (std::size_t r = 0; r < contacts; ++r) {
            for (std::size_t k = 0; k < ways; ++k) problem.q[r] += G[r * ways + k] * drive[k];
            for (std::size_t c = 0; c < contacts; ++c)
                for (std::size_t k = 0; k < ways; ++k) problem.at(r, c) += G[r * ways + k] * G[c * ways + k];
        }
        ASSERT_TRUE(problem.solve()) << round;
        double largest = 0.0;
        for (const double z : problem.z) largest = std::max(largest, z);
        for (std::size_t r = 0; r < contacts; ++r) {
            double w = problem.q[r];
            for (std::size_t c = 0; c < contacts; ++c) w += problem.at(r, c) * problem.z[c];
            EXPECT_GE(problem.z[r], 0.0) << round;
            EXPECT_GE(w, -1e-10 * (1.0 + largest)) << round;
            EXPECT_LE(std::abs(w * problem.z[r]), 1e-9 * (1.0 + largest) * (1.0 + largest)) << round;
        }
    }
}

// More contacts than needed share their load evenly.
TEST(Complementarity, EqualContactsShareEvenly) {
    Complementarity problem(3);
    for (std::size_t r = 0; r < 3; ++r) {
        problem.q[r] = -3.0;
        for (std::size_t c = 0; c < 3; ++c) problem.at(r, c) = 1.0;
    }
    ASSERT_TRUE(problem.solve());
    for (const double z : problem.z) EXPECT_NEAR(z, 1.0, 1e-3);
}

}  // namespace
}  // namespace carom
