// The checker catches a record that breaks a law, and names the law.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "physics/motion.h"
#include "reference/random_impacts.h"
#include "support/engine_cases.h"

namespace carom::test {
namespace {

/// Two balls roll one behind the other on a table; the second is hit, and both come to rest.
Plan roll_and_hit() {
    Scene scene = empty_scene();
    scene.table = make_table("nine_foot");
    scene.balls.mu_s = 0.0;  // no cloth in the impact, so U5 and U6 are exact
    scene.stop.time = 2.0;
    add_ball(scene, "a", {0.5, 0.5, scene.balls.R}, {0.0, 0.8, 0.0}, {-0.8 / scene.balls.R, 0.0, 0.0});
    add_ball(scene, "b", {0.52, 0.9, scene.balls.R});
    return plan_of(scene);
}

TEST(Verify, NamesTheBrokenLaw) {
    const Plan plan = roll_and_hit();
    const Record good = simulate(plan);
    ASSERT_EQ(verify(good, plan), std::nullopt);
    std::size_t hit = 0;
    while (hit < good.events.size() && good.events[hit].type != EventType::kBallBall) ++hit;
    ASSERT_LT(hit, good.events.size());
    const auto after_hit = [&](Record& r) -> Segment& {
        for (Segment& s : r.tracks[1].segments)
            if (s.start == good.events[hit].time) return s;
        throw std::runtime_error("the ball that was hit has no segment there");
    };
    const struct {
        const char *law, *says;
        std::function<void(Record&)> spoil;
    } cases[] = {
        {"U1", "ball b at 0 s has a number that is not finite",
         [](Record& r) { r.tracks[1].segments[0].v.x() = std::numeric_limits<double>::quiet_NaN(); }},
        {"U2", "time falls from",
         [&](Record& r) {
             r.events.push_back(r.events[hit]);
             r.events.back().time = 0.0;
         }},
        {"U5", "ball_ball leaves a residual of", [&](Record& r) { after_hit(r).v *= 0.9; }},
        {"U5", "ball_ball leaves a residual of", [&](Record& r) { after_hit(r).w *= 0.5; }},
        {"U6", "changes its motion at",
         [&](Record& r) { r.events.erase(r.events.begin() + static_cast<std::ptrdiff_t>(hit)); }},
        {"U7", "ball a is rolling at",
         [&](Record& r) {
             Segment& s = r.tracks[0].segments.back();
             s.state = MotionState::kRolling;
             s.w = Vec3::Zero();
         }},
        {"U8", "ball a has not come to rest", [](Record& r) { r.stopped = StopReason::kAtRest; }},
    };
    for (const auto& c : cases) {
        Record bad = good;
        c.spoil(bad);
        const std::optional<Violation> violation = verify(bad, plan);
        ASSERT_TRUE(violation) << c.law << " " << c.says;
        EXPECT_EQ(violation->law, c.law) << violation->message;
        EXPECT_NE(violation->message.find(c.says), std::string::npos) << violation->message;
    }
}

/// A straight shot: the balls' slip is vertical only, and the cloth's impulse meets its limit exactly.
Scene straight_shot(reference::Generator& random, double tolerance) {
    Scene scene = empty_scene();
    scene.physics.tolerance = tolerance;
    scene.balls.mu_b = random.uniform(0.001, 0.1);
    scene.balls.mu_s = random.uniform(0.1, 0.4);
    const double v = random.uniform(0.5, 6.0), spin = random.uniform(-150.0, 150.0);
    add_ball(scene, "cue", 0.0, 0.0, 0.0, v, Vec3(spin, 0.0, 0.0));
    add_ball(scene, "one", 0.0, random.uniform(0.1, 0.5));
    scene.stop.time = 2.0;
    return scene;
}

/// The record up to its impact, with the struck ball's speed then reduced by this share.
void spoil_impact(const Plan& plan, Record& record, double share) {
    const auto hit = std::find_if(record.events.begin(), record.events.end(),
                                  [](const Event& e) { return e.type == EventType::kBallBall; });
    const Event impact = *hit;
    record.events.erase(hit + 1, record.events.end());
    record.stopped = StopReason::kTime;
    record.duration = impact.time;
    for (BallTrack& track : record.tracks)
        std::erase_if(track.segments, [&](const Segment& s) { return s.start > impact.time; });
    Segment& s = record.tracks[static_cast<std::size_t>(impact.b)].segments.back();
    s = start_segment(s.start, s.r, (1.0 - share) * s.v, s.w,
                      plan.motion[static_cast<std::size_t>(impact.b)]);
}

/// A ball that runs into two touching balls, without cloth friction.
Plan small_cluster() {
    Scene scene = empty_scene();
    scene.balls.mu_s = 0.0;
    const double R = scene.balls.R;
    add_ball(scene, "a", 0.01, -4.0 * R, 0.0, 3.0);
    add_ball(scene, "b", 0.0, 0.0);
    add_ball(scene, "c", 0.02, 0.0 + std::sqrt(4.0 * R * R - 4e-4));
    scene.stop.time = 0.1;
    return plan_of(scene);
}

TEST(Verify, ChecksTheLawsOfLastingClusters) {
    const Plan plan = small_cluster();
    const Record good = simulate(plan);
    ASSERT_EQ(verify(good, plan), std::nullopt);
    const auto is_colliding = [](const Segment& s) { return s.state == MotionState::kColliding; };
    const auto after = [&](Record& r, std::size_t ball) -> Segment& {
        std::vector<Segment>& segments = r.tracks[ball].segments;
        return *(std::find_if(segments.begin(), segments.end(), is_colliding) + 1);
    };
    const struct {
        const char *law, *says;
        std::function<void(Record&)> spoil;
    } cases[] = {
        {"U5", "the hits of the cluster leave", [&](Record& r) { after(r, 1).v *= 0.9; }},
        {"U4", "energy rises",
         [&](Record& r) {
             Segment& s = after(r, 2);
             s.w.z() = (&s - 1)->w.z() = 1000.0;
         }},
    };
    for (const auto& c : cases) {
        Record bad = good;
        c.spoil(bad);
        const std::optional<Violation> violation = verify(bad, plan);
        ASSERT_TRUE(violation) << c.law << " " << c.says;
        EXPECT_EQ(violation->law, c.law) << violation->message;
        EXPECT_NE(violation->message.find(c.says), std::string::npos) << violation->message;
    }
}

// A record that ends during a cluster also has the motion after it.
TEST(Verify, ARunStopsInsideACluster) {
    const Plan plan = small_cluster();
    const Record whole = simulate(plan);
    const Segment* colliding = nullptr;
    for (const Segment& s : whole.tracks[1].segments)
        if (s.state == MotionState::kColliding) colliding = &s;
    ASSERT_NE(colliding, nullptr);
    const double middle = colliding->start + 0.5 * colliding->duration;
    const Record part = simulate(plan, {.until = middle, .progress = {}});
    EXPECT_EQ(part.duration, middle);
    EXPECT_EQ(part.state_at(1, middle).state, MotionState::kColliding);
    EXPECT_GT(part.tracks[1].segments.back().start, middle);
    EXPECT_EQ(verify(part, plan), std::nullopt);
    // The next shot begins after the cluster.
    const Scene next = scene_after(plan.scene, part);
    EXPECT_EQ(next.ball[1].velocity, part.tracks[1].segments.back().v);
}

TEST(Verify, EnergyMayNotRiseInTheLastCluster) {
    Scene scene = read_scene(CAROM_SOURCE_DIR "/scenes/eight_ball_break.toml");
    scene.balls.mu_s = scene.balls.mu_r = 0.0;
    const Plan plan = plan_of(scene);
    const Record whole = simulate(plan);
    double hit = 0.0;
    for (const Event& e : whole.events)
        if (e.type == EventType::kBallCluster && hit == 0.0) hit = e.time;
    Record record = simulate(plan, {.until = hit + 2e-3, .progress = {}});
    ASSERT_EQ(record.events.back().type, EventType::kBallCluster);
    ASSERT_EQ(verify(record, plan), std::nullopt);
    // With the momentum kept.
    Vec3 mean = Vec3::Zero();
    for (const BallTrack& track : record.tracks) mean += track.segments.back().v / 16.0;
    for (BallTrack& track : record.tracks) track.segments.back().v += 0.2 * (track.segments.back().v - mean);
    const auto violation = verify(record, plan);
    ASSERT_TRUE(violation);
    EXPECT_EQ(violation->law, "U4") << violation->message;
}

// Frames, pages, glTF and samples read places from a record.
TEST(Verify, PlacesDoNotJumpInABreak) {
    constexpr double kStep = 1e-5, kFastest = 15.0;  // [s], [m/s]
    for (const char* name : {"eight_ball_break", "nine_ball_break"}) {
        const Record record =
            simulate(plan_of(read_scene(std::string(CAROM_SOURCE_DIR) + "/scenes/" + name + ".toml")));
        ASSERT_FALSE(record.clusters.empty());
        double longest = 0.0;
        for (int ball = 0; ball < static_cast<int>(record.tracks.size()); ++ball)
            for (double t = 0.0; t < 0.3; t += kStep)
                longest = std::max(
                    longest,
                    (record.state_at(ball, t + kStep).position - record.state_at(ball, t).position).norm());
        EXPECT_LT(longest, kFastest * kStep) << name;
    }
}

// The limit of U5 is two tolerances: 4000 correct shots pass, and a speed wrong by four fails.
TEST(Verify, StraightShotsMeetTheLimitOfU5) {
    for (const double tolerance : {1e-3, 1e-6}) {
        reference::Generator random(5);
        int hits = 0;
        for (int k = 0; k < 4000; ++k) {
            const Plan plan = plan_of(straight_shot(random, tolerance));
            Record record = simulate(plan);
            const auto violation = verify(record, plan);
            ASSERT_FALSE(violation) << "shot " << k << " at " << tolerance << ": " << violation->law << " "
                                    << violation->message;
            hits += count(record, EventType::kBallBall) > 0 ? 1 : 0;
            if (k % 40 != 0 || count(record, EventType::kBallBall) != 1) continue;
            spoil_impact(plan, record, 4.0 * tolerance);
            const auto wrong = verify(record, plan);
            ASSERT_TRUE(wrong) << "shot " << k << " at " << tolerance;
            EXPECT_EQ(wrong->law, "U5");
        }
        EXPECT_GT(hits, 3500);
    }
}

/// Each record is of a plan without the part that the ball should have met.
TEST(Verify, NothingIsMissed) {
    const auto rolling = [](Vec2 r, Vec2 v) {
        Scene scene = empty_scene();
        scene.stop.time = 0.5;
        add_ball(scene, "a", r.x(), r.y(), v.x(), v.y(), rolling_spin(v.x(), v.y(), scene.balls.R));
        return scene;
    };
    Scene balls = rolling({0.0, 0.0}, {0.0, 1.0});
    add_ball(balls, "b", 0.056, 0.2);
    // The centre is beyond the cushion at the end, or the ball passes it.
    Scene cushion = rolling({0.0, 0.0}, {1.0, 0.0}), fast = rolling({0.0, 0.0}, {100.0, 0.0});
    cushion.table.cushions = fast.table.cushions = {{"c", {0.5, -0.5}, {0.5, 0.5}, 0.036576}};
    Scene jaw = rolling({0.0, 0.0}, {1.0, 0.0});
    jaw.table.jaws = {{"j", {0.3, 0.06}, 0.035, 0.036576}};
    Scene pocket = rolling({0.0, 0.0}, {1.0, 0.0});
    pocket.table.pockets = {{"p", {0.25, 0.05}, 0.06, 0.08}};
    const struct {
        Scene scene;
        const char* says;
        std::function<void(Plan&)> blind;
    } cases[] = {{balls, "balls a and b overlap by", [](Plan& p) { p.pairs = false; }},
                 {cushion, "ball a is", [](Plan& p) { p.geometry.cushions.clear(); }},
                 {fast, "ball a passes through a cushion", [](Plan& p) { p.geometry.cushions.clear(); }},
                 {jaw, "deep in a jaw", [](Plan& p) { p.geometry.noses.clear(); }},
                 {pocket, "beyond the edge of pocket p", [](Plan& p) { p.geometry.pockets.clear(); }}};
    for (const auto& c : cases) {
        const Plan plan = plan_of(c.scene);
        Plan blind = plan;
        c.blind(blind);
        blind.geometry.noses.clear();
        const Record record = simulate(blind);
        ASSERT_TRUE(record.events.empty());
        const std::optional<Violation> violation = verify(record, plan);
        ASSERT_TRUE(violation) << c.says;
        EXPECT_EQ(violation->law, "U3") << violation->message;
        EXPECT_NE(violation->message.find(c.says), std::string::npos) << violation->message;
        EXPECT_EQ(verify(simulate(plan), plan), std::nullopt) << c.says;
    }
}

// Nothing touches behind an arc with ends, so only the passage itself shows: a ball that leaves a table of
// two half circles within one segment. A ball may enter from behind.
TEST(Verify, DetectsABallPassingARoundWall) {
    for (const bool out : {true, false}) {
        Scene scene = empty_scene();
        scene.balls.mu_s = scene.balls.mu_r = 0.0;
        scene.stop.time = 2.0;
        add_ball(scene, "ball", out ? 0.1 : 2.0, 0.05, out ? 1.0 : -1.0);
        const Record record = simulate(plan_of(scene));
        // Open at 89 degrees: in front of a closed wall there is no ball that comes from behind it.
        for (const double from : {90.0, 269.0})
            scene.table.jaws.push_back(
                {"w", {0.0, 0.0}, 0.5, scene.balls.R, "", "inside", from, from + 179.0});
        scene.effects.push_back({"cushions", true, {}});
        const std::optional<Violation> violation = verify(record, plan_of(scene));
        ASSERT_EQ(violation.has_value(), out);
        if (!out) continue;
        EXPECT_EQ(violation->law, "U3");
        EXPECT_NE(violation->message.find("ball ball passes through a round wall"), std::string::npos)
            << violation->message;
    }
}

}  // namespace
}  // namespace carom::test
