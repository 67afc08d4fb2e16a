// The repository's scenes do what their comments say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "carom/engine/simulate.h"

namespace {

using carom::ClusterModel;
using carom::EventType;
using carom::Record;
using carom::Scene;
using carom::Vec2;

/// The portable instruction set; records are the same on all.
Record run(const std::string& text, const std::string& name) {
    return simulate(make_plan(carom::parse_scene(text, name), carom::kernel::Isa::kScalar));
}

Record run(const std::string& name) {
    const std::string path = std::string(CAROM_SOURCE_DIR) + "/scenes/" + name + ".toml";
    return simulate(make_plan(carom::read_scene(path), carom::kernel::Isa::kScalar));
}

Vec2 place(const Record& r, int ball, double t) {
    return r.state_at(ball, t).position.head<2>();
}

/// Time of the first event of a type, or -1.
double first(const Record& r, EventType type) {
    for (const carom::Event& e : r.events) {
        if (e.type == type) return e.time;
    }
    return -1.0;
}

/// Distance by which the cue ball ends beyond its position at the hit, along the diagonal of the three
/// straight-in shots.
double advance_after_contact(const Record& r) {
    const double hit = first(r, EventType::kBallBall);
    EXPECT_GT(hit, 0.0);
    return (place(r, 0, r.duration) - place(r, 0, hit)).dot(Vec2(-std::sqrt(0.5), std::sqrt(0.5)));
}

TEST(SceneShots, StopFollowDraw) {
    const Record stop = run("stop"), follow = run("follow"), draw = run("draw");
    EXPECT_NEAR(advance_after_contact(stop), 0.0, 1e-3);
    EXPECT_NEAR(advance_after_contact(follow), 0.30, 0.01);
    EXPECT_NEAR(advance_after_contact(draw), -0.57, 0.01);
    for (const Record& r : {stop, follow, draw}) {
        ASSERT_GE(r.tracks[1].pocket, 0);
        EXPECT_EQ(r.table.pockets[r.tracks[1].pocket].id, "p3");
        EXPECT_EQ(r.tracks[0].pocket, -1);
    }
}

double object_ball_angle(const Record& r) {
    const Vec2 way = place(r, 1, r.duration) - place(r, 1, 0.0);
    return std::atan2(way.y(), way.x()) * 180.0 / 3.14159265358979323846;
}

TEST(SceneShots, HalfBallThrow) {
    EXPECT_NEAR(object_ball_angle(run("half_ball_throw")), 62.8, 0.05);
    const std::string shot =
        "[[ball]]\nposition = [0.635, 0.8]\nvelocity = [0, 0.5]\n[[ball]]\nid = \"1\"\nposition = [0.663575, "
        "0.855]\n";
    EXPECT_NEAR(object_ball_angle(
                    run("[physics]\nclusters = \"sequential\"\n[balls]\nmu_b = 0\n" + shot, "no throw")),
                60.0, 1e-6);
}

TEST(SceneShots, ThreeCushionScores) {
    const Record r = run("three_cushion");
    std::vector<std::string> met;
    for (const carom::Event& e : r.events) {
        if (e.type == EventType::kBallCushion && e.a == 0) met.push_back(r.partner_id(e));
        if (e.type == EventType::kBallBall && (e.a == 0 || e.b == 0))
            met.push_back(r.tracks[e.a == 0 ? e.b : e.a].id);
    }
    EXPECT_EQ(met, (std::vector<std::string>{"yellow", "c4", "c3", "c1", "c2", "red", "yellow"}));
}

TEST(SceneShots, NineBallBreakHitsTheOneFirst) {
    const Record r = run("nine_ball_break");
    for (const carom::Event& e : r.events) {
        if (e.type != EventType::kBallBall && e.type != EventType::kBallCluster) continue;
        EXPECT_EQ(r.tracks[e.a + e.b].id, "1");
        EXPECT_EQ(std::min(e.a, e.b), 0);
        break;
    }
    EXPECT_EQ(r.stopped, carom::StopReason::kAtRest);
}

// The wing ball is at the end of the third row on the cue ball's side. Only the model that treats a rack's
// contacts as one impact of elastic bodies sends it into the nearby corner.
TEST(SceneShots, TheWingBallDistinguishesTheModels) {
    const auto falls = [](ClusterModel model) {
        Scene scene = carom::read_scene(std::string(CAROM_SOURCE_DIR) + "/scenes/wing_ball.toml");
        scene.physics.clusters = model;
        const auto wing =
            std::min_element(scene.ball.begin() + 1, scene.ball.end(),
                             [](const auto& a, const auto& b) { return a.position.x() < b.position.x(); });
        const Record r = carom::simulate(carom::make_plan(scene, carom::kernel::best_isa()));
        const int pocket = r.tracks[static_cast<std::size_t>(wing - scene.ball.begin())].pocket;
        return pocket >= 0 && r.table.pockets[static_cast<std::size_t>(pocket)].id == "p3";
    };
    EXPECT_TRUE(falls(ClusterModel::kCompliant));
    EXPECT_FALSE(falls(ClusterModel::kSequential));
    EXPECT_FALSE(falls(ClusterModel::kRigid));
}

TEST(SceneShots, HelloMeetsTwice) {
    const Record r = run("hello");
    int meetings = 0;
    for (const carom::Event& e : r.events) meetings += e.type == EventType::kBallBall;
    EXPECT_EQ(meetings, 2);
    EXPECT_EQ(r.duration, 4.0);
}

/// The contacts of a ball, in order: ids of balls, cushions and jaws.
std::vector<std::string> met_by(const Record& r, int ball) {
    std::vector<std::string> met;
    for (const carom::Event& e : r.events) {
        const bool table = e.type == EventType::kBallCushion || e.type == EventType::kBallJaw;
        const bool pair = e.type == EventType::kBallBall || e.type == EventType::kBallCluster;
        if (table && e.a == ball) met.push_back(r.partner_id(e));
        if (pair && (e.a == ball || e.b == ball)) met.push_back(r.tracks[e.a == ball ? e.b : e.a].id);
    }
    return met;
}

TEST(SceneShots, CaromOpeningsScore) {
    for (const char* name : {"carom_opening", "carom_small_opening"}) {
        const std::vector<std::string> met = met_by(run(name), 0);
        ASSERT_GE(met.size(), 5u) << name;
        EXPECT_EQ(std::vector<std::string>(met.begin(), met.begin() + 5),
                  (std::vector<std::string>{"red", "c3", "c2", "c1", "yellow"}))
            << name;
    }
}

TEST(SceneShots, BreaksPotTheStatedBalls) {
    const auto pocketed = [](const std::string& name) {
        std::string ids;
        for (const carom::BallTrack& track : run(name).tracks)
            if (track.pocket >= 0) ids += track.id + " ";
        return ids;
    };
    EXPECT_EQ(pocketed("one_in_the_side"), "1 6 ");
    EXPECT_EQ(pocketed("soft_break"), "1 ");
    EXPECT_EQ(pocketed("tight_nine_ball_break"), "1 2 7 ");
    EXPECT_EQ(pocketed("ten_foot_break"), "1 ");
    EXPECT_EQ(pocketed("chinese_eight_ball_break"), "");
    EXPECT_GT(first(run("chinese_eight_ball_break"), EventType::kBallJaw), 0.0);
    const Record snooker = run("snooker_ten_foot_break");
    EXPECT_LT(place(snooker, 0, snooker.duration).y(), 0.6);
}

TEST(SceneShots, MasseGoesAroundYellow) {
    const Record r = run("masse");
    ASSERT_FALSE(met_by(r, 0).empty());
    EXPECT_EQ(met_by(r, 0)[0], "red");
    // Right of yellow first, then left of its initial direction.
    const double hit = first(r, EventType::kBallBall);
    double most = 0.0;
    for (double t = 0.0; t < hit; t += 0.01) most = std::max(most, place(r, 0, t).x());
    EXPECT_GT(most, 0.80);
    EXPECT_LT(place(r, 0, hit).x(), 0.72);
    // Red hides behind yellow: the straight line passes yellow at less than two radii.
    const Vec2 to_red = (place(r, 2, 0.0) - place(r, 0, 0.0)).normalized();
    EXPECT_LT(std::abs(carom::cross(to_red, place(r, 1, 0.0) - place(r, 0, 0.0))), 2.0 * r.balls.R);
}

/// Whether the ball is in the air at this time.
bool is_up(const Record& r, int ball, double t) {
    return r.state_at(ball, t).state == carom::MotionState::kAirborne;
}

TEST(SceneShots, JumpFliesOverRed) {
    const Record r = run("jump");
    ASSERT_FALSE(met_by(r, 0).empty());
    EXPECT_EQ(met_by(r, 0)[0], "yellow");
    double t = 0.0;
    while (place(r, 0, t).y() < place(r, 1, 0.0).y()) t += 1e-4;
    EXPECT_TRUE(is_up(r, 0, t));
    EXPECT_LT(std::abs(place(r, 0, t).x() - place(r, 1, 0.0).x()), 1e-9) << "straight over it";
    EXPECT_GT(r.state_at(0, t).position.z(), 3.0 * r.balls.R);
}

TEST(SceneShots, JumpPotPotsYellow) {
    const Record r = run("jump_pot");
    EXPECT_EQ(met_by(r, 0)[0], "yellow");
    EXPECT_NE(r.tracks[2].pocket, -1);
    EXPECT_EQ(r.tracks[0].pocket, -1);
    // Red blocks the path to yellow.
    const Vec2 way = (place(r, 0, 0.05) - place(r, 0, 0.0)).normalized();
    EXPECT_LT(std::abs(carom::cross(way, place(r, 1, 0.0) - place(r, 0, 0.0))), 2.0 * r.balls.R);
}

TEST(SceneShots, SwerveGoesAroundYellow) {
    const Record r = run("swerve");
    ASSERT_FALSE(met_by(r, 0).empty());
    EXPECT_EQ(met_by(r, 0)[0], "red");
    EXPECT_TRUE(is_up(r, 0, 0.02));
    const Vec2 to_red = (place(r, 2, 0.0) - place(r, 0, 0.0)).normalized();
    EXPECT_LT(std::abs(carom::cross(to_red, place(r, 1, 0.0) - place(r, 0, 0.0))), 2.0 * r.balls.R);
}

TEST(SceneShots, RaisedBreakArrivesInTheAir) {
    const Record r = run("raised_break");
    const double hit = first(r, EventType::kBallCluster);  // rack and airborne ball together
    EXPECT_TRUE(is_up(r, 0, hit - 1e-3) || is_up(r, static_cast<int>(r.tracks.size()) - 1, hit - 1e-3));
}

TEST(SceneShots, SnookerBreakReturnsToBaulk) {
    const Record r = run("snooker_break");
    int cue = -1;
    for (std::size_t i = 0; i < r.tracks.size(); ++i)
        if (r.tracks[i].id == "cue") cue = static_cast<int>(i);
    ASSERT_EQ(r.tracks.size(), 22u);
    const std::vector<std::string> met = met_by(r, cue);
    ASSERT_EQ(met.size(), 5u);
    EXPECT_EQ(std::vector<std::string>(met.begin() + 1, met.end()),
              (std::vector<std::string>{"c9", "c12", "c3", "c18"}));
    EXPECT_LT(place(r, cue, r.duration).y(), 1.0);
    for (const carom::BallTrack& track : r.tracks) EXPECT_EQ(track.pocket, -1) << track.id;
}

}  // namespace
