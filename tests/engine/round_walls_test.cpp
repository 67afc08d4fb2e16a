// Round walls around balls: no ball leaves, none gains energy, and none loses any without a cause.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "carom/engine/cushion.h"
#include "reference/random_impacts.h"
#include "support/hard_scenes.h"

namespace carom::test {
namespace {

using reference::kDegree;

Jaw wall(const Vec2& center, double radius, double from_deg = 0.0, double to_deg = 360.0) {
    return {"w", center, radius, 0.028575, "", "inside", from_deg, to_deg};
}

/// A table, and the distance from a point inside to its walls.
struct Round {
    Table table;
    Vec2 size;  ///< half of its box
    std::function<double(const Vec2&)> room;
};

Round circle(double radius) {
    Round round{{}, {radius, radius}, [radius](const Vec2& r) { return radius - length(r); }};
    round.table.jaws.push_back(wall(Vec2::Zero(), radius));
    return round;
}

Round stadium(double radius, double half) {
    Round round{{}, {radius + half, radius}, [=](const Vec2& r) {
                    return radius - length(r - Vec2(std::clamp(r.x(), -half, half), 0.0));
                }};
    round.table.cushions.push_back({"c1", {-half, -radius}, {half, -radius}, 0.028575});
    round.table.cushions.push_back({"c2", {-half, radius}, {half, radius}, 0.028575});
    round.table.jaws.push_back(wall({-half, 0.0}, radius, 90.0, 270.0));
    round.table.jaws.push_back(wall({half, 0.0}, radius, -90.0, 90.0));
    return round;
}

/// Two arcs of this radius whose centres are 2 c apart.
Round lens(double radius, double c) {
    const double half = std::acos(c / radius) / kDegree;
    Round round{{}, {radius - c, radius * std::sin(half * kDegree)}, [=](const Vec2& r) {
                    return radius - std::max(length(r - Vec2(c, 0.0)), length(r - Vec2(-c, 0.0)));
                }};
    round.table.jaws.push_back(wall({-c, 0.0}, radius, -half, half));
    round.table.jaws.push_back(wall({c, 0.0}, radius, 180.0 - half, 180.0 + half));
    return round;
}

/// One to three balls: with spins at rest, or with plastic walls and no friction, or pucks.
Scene random_scene(reference::Generator& rng, Round& round, int kind) {
    const double radius = rng.uniform(0.15, 1.0);
    const double shape = rng.uniform(0.0, 3.0);
    round = shape < 1.0   ? circle(radius)
            : shape < 2.0 ? stadium(radius, rng.uniform(0.1, 1.0))
                          : lens(radius, radius * rng.uniform(0.05, 0.5));
    Scene scene = empty_scene();
    scene.table = round.table;
    scene.stop.time = 20.0;
    scene.stop.events = 2000;
    if (kind > 0) {
        scene.balls.e_c = scene.balls.f_c = scene.balls.mu_b = 0.0;
        scene.physics.cushion = &kSmooth;
    }
    if (kind == 1) scene.balls.mu_s = scene.balls.mu_r = scene.balls.mu_sp = 0.0;
    if (kind == 2) {
        scene.balls.slides = 1.0;
        scene.balls.mu_s = 0.05;
    }
    const double R = scene.balls.R;
    for (int k = 0; k < 3; ++k) {
        const Vec2 r(round.size.x() * rng.uniform(-1.0, 1.0), round.size.y() * rng.uniform(-1.0, 1.0));
        bool fits = round.room(r) > R;
        for (const BallStart& other : scene.ball) fits = fits && length(planar(other.position) - r) > 2.0 * R;
        const Vec3 w(rng.uniform(-150.0, 150.0), rng.uniform(-150.0, 150.0), 0.0);
        const double vx = rng.uniform(-1.5, 1.5), vy = rng.uniform(-1.5, 1.5);
        if (fits)
            add_ball(scene, std::to_string(k), r.x(), r.y(), kind > 0 ? vx : 0.0, kind > 0 ? vy : 0.0,
                     kind > 0 ? Vec3(Vec3::Zero()) : w);
    }
    return scene;
}

void nothing_leaves(int count, std::uint64_t seed) {
    reference::Generator rng(seed);
    int runs = 0;
    for (int k = 0; runs < count; ++k) {
        Round round;
        const Scene scene = random_scene(rng, round, k % 3);
        if (scene.ball.empty()) continue;
        ++runs;
        SCOPED_TRACE("scene " + std::to_string(k));
        const Record record = run_verified(scene);
        for (std::size_t i = 0; i < scene.ball.size(); ++i) {
            const BallState end = record.state_at(static_cast<int>(i), record.duration);
            EXPECT_GE(round.room(planar(end.position)), scene.balls.R - 1e-9) << "ball " << i;
        }
    }
}

// 5 % of spinning balls once rolled through the wall, and 22 % of those sliding along a plastic wall flew
// out.
TEST(RoundWalls, NoBallLeaves) {
    nothing_leaves(300, 1);
}

class RoundTables : public testing::TestWithParam<int> {};

TEST_P(RoundTables, NoBallLeavesTwoThousand) {
    nothing_leaves(2000, 2 + static_cast<std::uint64_t>(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Part, RoundTables, testing::Range(0, 5));

// The cloth bends the path outwards: only the coefficient of t^4 reveals the contact.
TEST(RoundWalls, AreDetectedForABallThatStartsWithSpinAlone) {
    for (const bool whole : {true, false}) {
        Scene scene = empty_scene();
        constexpr double kRadius = 0.20385982484290271;
        if (whole)
            scene.table.jaws.push_back(wall(Vec2::Zero(), kRadius));
        else
            for (const double from : {100.0, 280.0})
                scene.table.jaws.push_back(wall(Vec2::Zero(), kRadius, from, from + 180.0));
        add_ball(scene, "ball", 0.06947013578399049, 0.015757496378524482, 0.0, 0.0,
                 Vec3(-123.65359461114068, -119.42662797918973, 0.0));
        const Record record = run_verified(scene);
        EXPECT_GE(count(record, EventType::kBallJaw), 1);
        EXPECT_LE(length(planar(record.state_at(0, record.duration).position)),
                  kRadius - scene.balls.R + 1e-12);
    }
}

// After its impact the ball touches the wall and moves along it, outside the circle by rounding.
TEST(RoundWalls, KeepAPlasticBall) {
    for (const bool whole : {true, false}) {
        Scene scene = frictionless();
        scene.balls.e_c = 0.0;
        if (whole)
            scene.table.jaws.push_back(wall(Vec2::Zero(), 0.5));
        else
            for (const double from : {100.0, 280.0})
                scene.table.jaws.push_back(wall(Vec2::Zero(), 0.5, from, from + 180.0));
        add_ball(scene, "ball", 0.1, 0.0, 0.5, 0.1);
        scene.stop.time = 60.0;
        const Record record = run_verified(scene);
        EXPECT_NEAR(length(planar(record.state_at(0, 60.0).position)), 0.5 - scene.balls.R, 1e-7);
    }
}

// Once a run failed after a million such intervals. With the least friction it comes to rest, and with a ball
// in its path it has another event.
TEST(RoundWalls, APlasticBallRunsForEver) {
    Scene scene = frictionless();
    scene.balls.e_c = 0.0;
    scene.table.jaws.push_back(wall(Vec2::Zero(), 0.5));
    add_ball(scene, "ball", 0.1, 0.0, 0.5, 0.1);
    scene.stop.events = 100;
    const Record endless = run_verified(scene);
    EXPECT_EQ(endless.stopped, StopReason::kEndless);
    EXPECT_EQ(endless.events.size(), 2u);
    EXPECT_LT(endless.tracks[0].segments.size(), 10000u);

    Scene meets = scene;
    const double orbit = 0.5 - scene.balls.R;
    add_ball(meets, "other", 0.0, orbit - 0.01);
    EXPECT_GE(count(run_verified(meets), EventType::kBallBall), 1);

    Scene rests = scene;
    rests.balls.mu_s = rests.balls.mu_r = 1e-3;
    EXPECT_EQ(run_verified(rests).stopped, StopReason::kAtRest);
}

// A ball that ran along a wall of several arcs once left it at every joint: 2000 events in 1000 laps.
TEST(RoundWalls, ArcsThatContinueEachOtherAreOneWall) {
    for (const double e_c : {0.0, 0.9}) {
        const auto run = [&](const std::vector<double>& from, double turn) {
            Scene scene = frictionless();
            scene.balls.e_c = e_c;
            for (const double start : from)
                scene.table.jaws.push_back(wall(Vec2::Zero(), 0.5, start, start + turn));
            add_ball(scene, "ball", 0.1, 0.0, 0.5, 0.1);
            scene.stop.events = 20;
            return run_verified(scene);
        };
        const Record one = run({100.0}, 360.0), several = run({100.0, 340.0, 220.0}, 120.0);
        EXPECT_EQ(several.stopped, one.stopped);
        ASSERT_EQ(several.events.size(), one.events.size());
        EXPECT_EQ(several.state_at(0, several.duration).position, one.state_at(0, one.duration).position);
        for (const Event& event : several.events) {
            const Vec2 at = planar(several.state_at(0, event.time).position);
            EXPECT_TRUE(span_of(several.table.jaws[static_cast<std::size_t>(event.b)]).holds(at))
                << event.time;
        }
    }
}

// 13 of 24 such orbits once lost the speed at which they met the wall.
TEST(RoundWalls, ALosslessGrazeBounces) {
    for (int k = 0; k < 24; ++k) {
        Scene scene = frictionless();
        scene.physics.gravity = 0.0;
        scene.table.jaws.push_back(wall(Vec2::Zero(), 0.2));
        const double orbit = 0.2 - scene.balls.R, graze = 6.0 * kDegree * std::pow(0.5, k);
        add_ball(scene, "ball", orbit, 0.0, -3.0 * std::sin(graze), 3.0 * std::cos(graze));
        scene.stop.events = 50;
        scene.stop.time = 10.0;
        const Record record = run_verified(scene);
        // Within an interval, the velocity of a ball on the wall is along the chord.
        EXPECT_NEAR(record.tracks[0].segments.back().v.norm(), 3.0, 3e-12) << graze;
        if (graze < 1e-6) continue;
        ASSERT_EQ(count(record, EventType::kBallJaw), 50) << graze;
        // The first place and the square of the angle are both rounded.
        const double chord = 2.0 * orbit * std::sin(graze) / 3.0;
        EXPECT_NEAR(record.events.back().time / (50.0 * chord), 1.0, 5e-15 / (graze * graze)) << graze;
    }
}

// A ball laid against a lossless wall and set moving along it keeps its speed and stays at the wall.
TEST(RoundWalls, ALosslessRunnerKeepsItsSpeed) {
    for (const double off : {0.0, -1e-15, -1e-12, -1e-9, -1e-6}) {
        Scene scene = frictionless();
        scene.table.jaws.push_back(wall(Vec2::Zero(), 0.5));
        const double orbit = 0.5 - scene.balls.R;
        add_ball(scene, "ball", orbit + off, 0.0, 0.0, 1.0);
        scene.stop.time = 3.0;
        scene.stop.events = 2000;
        EXPECT_NEAR(run_verified(scene).tracks[0].segments.back().v.norm(), 1.0, 1e-12) << off;
    }
}

// Balls that run along a round wall and lean on each other. Their energy once rose in every such scene.
TEST(RoundWalls, GroupsGainNoEnergy) {
    reference::Generator rng(6);
    for (int k = 0; k < 20; ++k) {
        Scene scene = empty_scene();
        scene.physics.cushion = &kSmooth;
        scene.balls.mu_b = scene.balls.e_b = scene.balls.e_c = scene.balls.f_c = 0.0;
        scene.table.jaws.push_back(wall(Vec2::Zero(), 0.5));
        const double R = scene.balls.R, orbit = 0.5 - R, apart = 2.0 * std::asin(R / orbit);
        double angle = 0.0;
        for (int ball = 0; ball < 3; ++ball) {
            const Vec2 out(std::cos(angle), std::sin(angle)), along(-out.y(), out.x());
            const double speed = rng.uniform(0.5, 1.5) - 0.3 * ball;
            add_ball(scene, std::to_string(ball), orbit * out.x(), orbit * out.y(), speed * along.x(),
                     speed * along.y(), rolling_spin(speed * along.x(), speed * along.y(), R));
            angle += apart + (ball == 0 ? 1e-9 : rng.uniform(0.0, 0.3));
        }
        scene.stop.events = 300;
        run_verified(scene);
    }
}

}  // namespace
}  // namespace carom::test
