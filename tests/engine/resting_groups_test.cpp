// Groups of balls in resting contacts: one small scene for each class of failure from the random scenes, and
// the solver of their forces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "carom/engine/cushion.h"

#include "contact/complementarity.h"
#include "support/random_scenes.h"

namespace carom {
namespace {

using namespace test;

Scene on_box() {
    Scene scene = empty_scene();
    scene.table = box(1.0, 2.0, 0.036576);
    scene.physics.cushion = &kSmooth;
    return scene;
}

// A passing ball pushes a resting ball against a cushion: it stays there, instead of repeatedly starting,
// stopping and separating.
TEST(RestingGroups, SqueezedAgainstACushionStaysAtRest) {
    Scene scene = on_box();
    const double R = scene.balls.R;
    add_ball(scene, "squeezed", 1.0 - R, 1.0);
    add_ball(scene, "pusher", 1.0 - 3.0 * R, 1.0, 0.0, 0.024, Vec3(-0.9, 1.3, 0.0));
    const Record record = run_verified(scene);
    EXPECT_LE(record.events.size(), 20u);
    EXPECT_NEAR(record.state_at(0, 1e-3).position.x(), 1.0 - R, 1e-12);
}

// A ball pressed into the narrow wedge of a cushion and a ball, whose normals are nearly opposite.
TEST(RestingGroups, WedgeOfNearlyOppositeNormals) {
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

// A pair begins to touch at 1e-12 m/s just before a third ball arrives at 1 m/s. The fast ball must scale the
// cluster's map; scaled by the slow one, it blew up.
TEST(RestingGroups, SlowTouchNextToAFastApproach) {
    Scene scene = empty_scene();
    const double R = scene.balls.R;
    add_ball(scene, "a", 0.0, 0.0, 1e-12, 0.0, rolling_spin(1e-12, 0.0, R));
    add_ball(scene, "b", 2.0 * R, 0.0);
    add_ball(scene, "c", 4.0 * R + 1e-7, 0.0, -1.0, 0.0, rolling_spin(-1.0, 0.0, R));
    const Record record = run_verified(scene);
    for (const double t : {1e-6, 1e-3, 0.1})
        for (int i = 0; i < 3; ++i) EXPECT_LE(record.state_at(i, t).velocity.norm(), 1.0 + 1e-9);
}

// A contact that closes only by rounding is held without an impact; one without force causes no events.
TEST(RestingGroups, BallsThatRestTogetherStayTogether) {
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

// Into both cushions of a corner at once, with and without spin, at every restitution.
TEST(RestingGroups, CornerComesToRest) {
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

// Converts rows to the columns that the problem needs.
void set_matrix(Complementarity& problem, const std::vector<double>& rows) {
    const std::size_t n = problem.size;
    for (std::size_t c = 0; c < n; ++c) {
        problem.begin_column();
        for (std::size_t r = 0; r < n; ++r)
            if (rows[r * n + c] != 0.0) problem.add(r, rows[r * n + c]);
    }
}

// z >= 0, w = A z + q >= 0, z w = 0 for A = G G^T, with up to twice as many contacts as directions.
TEST(Complementarity, RandomProblemsWithRedundantContacts) {
    reference::Generator rng(1);
    for (int round = 0; round < 2000; ++round) {
        const std::size_t contacts = 1 + static_cast<std::size_t>(rng.uniform(0.0, 12.0)), ways = 6;
        std::vector<double> G(contacts * ways), drive(ways);
        for (double& x : G) x = rng.uniform(-1.0, 1.0);
        for (double& x : drive) x = rng.uniform(-1.0, 1.0);
        Complementarity problem;
        problem.resize(contacts);
        std::vector<double> A(contacts * contacts);
        for (std::size_t r = 0; r < contacts; ++r) {
            for (std::size_t k = 0; k < ways; ++k) problem.q[r] += G[r * ways + k] * drive[k];
            for (std::size_t c = 0; c < contacts; ++c)
                for (std::size_t k = 0; k < ways; ++k)
                    A[r * contacts + c] += G[r * ways + k] * G[c * ways + k];
        }
        set_matrix(problem, A);
        ASSERT_TRUE(problem.solve()) << round;
        double largest = 0.0;
        for (const double z : problem.z) largest = std::max(largest, z);
        for (std::size_t r = 0; r < contacts; ++r) {
            double w = problem.q[r];
            for (std::size_t c = 0; c < contacts; ++c) w += A[r * contacts + c] * problem.z[c];
            EXPECT_GE(problem.z[r], 0.0) << round;
            EXPECT_GE(w, -1e-10 * (1.0 + largest)) << round;
            EXPECT_LE(std::abs(w * problem.z[r]), 1e-9 * (1.0 + largest) * (1.0 + largest)) << round;
        }
    }
}

// A wedge whose normals differ by `tilt`: compared with its smallest eigenvalue, tilt^2, the softness is
// large, and refinement must remove its effect.
TEST(Complementarity, NarrowWedgeIsSolvedToRounding) {
    for (const double tilt : {1e-3, 1e-4, 1e-5, 5e-6}) {
        const double cosine = std::sqrt(1.0 - tilt * tilt);
        Complementarity problem;
        problem.resize(2);
        set_matrix(problem, {1.0, -cosine, -cosine, 1.0});
        problem.q = {0.0, -tilt};  // pressed along the wedge
        ASSERT_TRUE(problem.solve()) << tilt;
        for (std::size_t r = 0; r < 2; ++r) {
            const double w = problem.q[r] + (problem.z[r] - cosine * problem.z[1 - r]);
            EXPECT_LE(std::abs(w), 2.0 * std::numeric_limits<double>::epsilon() * problem.z[r]) << tilt;
        }
    }
}

// Two balls between two walls, one of which returns: the three rates sum to zero, so only rounding says which
// contacts press.
TEST(Complementarity, RoundingDoesNotDecide) {
    Complementarity problem;
    problem.resize(3);
    set_matrix(problem, {1.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 1.0});
    const double slow = 3.34389e-11, fast = 0.000165999;
    problem.q = {slow, fast - slow, -fast * (1.0 + 1e-15)};
    ASSERT_TRUE(problem.solve());
    const std::vector<double>& z = problem.z;
    const double w[] = {problem.q[0] + z[0] - z[1], problem.q[1] + 2.0 * z[1] - z[0] - z[2],
                        problem.q[2] + z[2] - z[1]};
    for (int k = 0; k < 3; ++k) {
        EXPECT_GE(z[k], 0.0);
        EXPECT_GE(w[k], -4e-15 * fast) << "1e-15 cannot be removed, the rest is the rounding of a row";
        EXPECT_LE(std::abs(w[k] * z[k]), 1e-14 * fast * fast);
    }
}

TEST(Complementarity, EqualContactsShareEvenly) {
    Complementarity problem;
    problem.resize(3);
    problem.q.assign(3, -3.0);
    set_matrix(problem, std::vector<double>(9, 1.0));
    ASSERT_TRUE(problem.solve());
    for (const double z : problem.z) EXPECT_NEAR(z, 1.0, 1e-3);
}

}  // namespace
}  // namespace carom
