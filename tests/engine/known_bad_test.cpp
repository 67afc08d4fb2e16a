// Six degenerate inputs on which another simulator is wrong (tests/data/engine/known_bad.json), judged by
// their `expected` text.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "carom/engine/ball_ball.h"
#include "carom/engine/math.h"
#include "support/hard_scenes.h"

namespace carom {
namespace {

using namespace test;

nlohmann::json case_named(const std::string& wanted) {
    const auto data = read_json("known_bad.json");
    for (const auto& c : data.at("cases"))
        if (c.at("name") == wanted) return c;
    throw std::runtime_error("no case " + wanted);
}

Scene scene_named(const std::string& wanted) {
    const auto c = case_named(wanted);
    Scene scene = empty_scene();
    const auto& t = c.at("table");
    scene.table = box(t.at("w").get<double>(), t.at("l").get<double>(), t.at("cushion_height").get<double>());
    scene.balls = balls_from(c.at("params"));
    scene.physics.gravity = c.at("params").at("g").get<double>();
    scene.physics.ball_ball = ball_ball_model("inelastic");
    for (const auto& [id, s] : c.at("initial").items())
        add_ball(scene, id, vec3(s.at("r")), vec3(s.at("v")), vec3(s.at("w")));
    if (c.contains("cue")) {
        const auto& q = c.at("cue");
        Cue cue;
        cue.ball = "cue";
        cue.speed = q.at("V0").get<double>();
        cue.aim_deg = q.at("phi_deg").get<double>();
        cue.elevation_deg = q.at("theta_deg").get<double>();
        cue.side = q.at("a").get<double>();
        cue.height = q.at("b").get<double>();
        cue.restitution = 1.0;
        cue.mass = q.at("M").get<double>();
        cue.end_mass = q.at("end_mass").get<double>();
        scene.cue = cue;
        scene.physics.vertical = Vertical::kDrop;  // the references are planar
    }
    return scene;
}

int ball(const Record& record, const std::string& id) {
    for (std::size_t i = 0; i < record.tracks.size(); ++i)
        if (record.tracks[i].id == id) return static_cast<int>(i);
    return -1;
}

// Every contact is at 2 R, and no ball jumps between segments.
void expect_no_jumps(const Record& record) {
    for (const Event& e : record.events) {
        if (e.type != EventType::kBallBall) continue;
        const Vec3 p = record.state_at(e.a, e.time).position, q = record.state_at(e.b, e.time).position;
        report("known bad: gap at contact", std::abs((p - q).norm() - 2.0 * record.balls.R));
        EXPECT_NEAR((p - q).norm(), 2.0 * record.balls.R, 1e-13);
    }
    for (const BallTrack& track : record.tracks) {
        for (std::size_t k = 1; k < track.segments.size(); ++k) {
            const Segment &s = track.segments[k - 1], &next = track.segments[k];
            EXPECT_LE((position_at(s, next.start - s.start) - next.r).norm(), 1e-13)
                << track.id << " segment " << k;
        }
    }
}

TEST(KnownBad, EqualAccelerationFalseCollision) {
    const Record record = run_verified(scene_named("equal_acceleration_false_collision"));
    const Event* hit = first(record, EventType::kBallBall);
    ASSERT_NE(hit, nullptr);
    EXPECT_NEAR(hit->time, 0.2, 1e-14);
    EXPECT_EQ(record.events[0].time, hit->time) << "nothing before it";
    expect_no_jumps(record);
}

TEST(KnownBad, TouchingSameVelocity) {
    const Record record = run_verified(scene_named("touching_same_velocity_crash"));
    // At 1 m/s the pair would travel 5 m: the first event is the leading ball at the cushion.
    ASSERT_FALSE(record.events.empty());
    EXPECT_EQ(record.events[0].type, EventType::kBallCushion);
    for (double t = 0.0; t < record.events[0].time; t += 0.05)
        EXPECT_NEAR((record.state_at(0, t).position - record.state_at(1, t).position).norm(),
                    2.0 * record.balls.R, 1e-15);
    // On an endless cloth only the two stops happen, after v / (mu_r g), at the same relative position.
    Scene endless = scene_named("touching_same_velocity_crash");
    endless.table = Table();
    const Record alone = run_verified(endless);
    EXPECT_EQ(alone.events.size(), 2u);
    EXPECT_EQ(count(alone, EventType::kRollStop), 2);
    EXPECT_NEAR(alone.duration, 1.0 / (0.01 * 9.81), 1e-13);
}

TEST(KnownBad, TouchingCushionEscape) {
    const Record record = run_verified(scene_named("touching_cushion_escape"));
    ASSERT_FALSE(record.events.empty());
    EXPECT_EQ(record.events[0].type, EventType::kBallCushion);
    EXPECT_LE(record.events[0].time, 1e-16) << "0.971425 is 1.7e-17 short of the cushion";
    EXPECT_LT(record.state_at(0, 1e-16).velocity.x(), 0.0);
    for (double t = 0.0; t < record.duration; t += 0.05)
        ASSERT_LE(record.state_at(0, t).position.x(), 1.0 - record.balls.R + 1e-12);
}

TEST(KnownBad, SymmetricDoubleHit) {
    const Record record = run_verified(scene_named("symmetric_double_hit"));
    const Event* hit = first(record, EventType::kBallCluster);
    ASSERT_NE(hit, nullptr);
    EXPECT_EQ(record.clusters[0].balls.size(), 3u);
    const Vec3 a = record.state_at(ball(record, "a"), hit->time).velocity;
    const Vec3 l = record.state_at(ball(record, "L"), hit->time).velocity,
               r = record.state_at(ball(record, "Rr"), hit->time).velocity;
    report("known bad: asymmetry",
           std::max({std::abs(a.x()), std::abs(l.x() + r.x()), std::abs(l.y() - r.y())}));
    EXPECT_LE(std::abs(a.x()), 1e-12);
    EXPECT_NEAR(l.x(), -r.x(), 1e-12);
    EXPECT_NEAR(l.y(), r.y(), 1e-12);
}

// The line of the two balls, and the first cushion not yet hit.
TEST(KnownBad, StraightFollowAt45Degrees) {
    const Record record = run_verified(scene_named("straight_follow_45deg"));
    EXPECT_EQ(record.events[0].type, EventType::kCueStrike);
    expect_no_jumps(record);
    const Event* hit = first(record, EventType::kBallBall);
    ASSERT_NE(hit, nullptr);
    const double R = record.balls.R;
    const Vec3 cue = record.state_at(ball(record, "cue"), hit->time).position;
    EXPECT_NEAR((Vec3(1.3535533905932737, 1.3535533905932737, R) - cue).norm(), 2.0 * R, 1e-13);
    EXPECT_LE(record.events.size(), 60u);
}

TEST(KnownBad, Issue375DrawShot) {
    const Record record = run_verified(scene_named("issue375_draw_shot"));
    expect_no_jumps(record);
    EXPECT_NEAR(record.state_at(ball(record, "cue"), 0.0).velocity.y(), 2.7272792863859703, 1e-9)
        << "the cue's strike";
    const Event* hit = first(record, EventType::kBallBall);
    ASSERT_NE(hit, nullptr);
    EXPECT_NEAR(hit->time, 0.2925239113400267, 1e-6) << "the other simulator stands the balls 1e-6 m apart";
    EXPECT_LE(record.events.size(), 60u) << "it took 136";
}

}  // namespace
}  // namespace carom
