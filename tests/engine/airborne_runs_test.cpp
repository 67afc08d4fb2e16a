// Whole shots with balls in the air.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "carom/engine/airborne.h"
#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/math.h"
#include "carom/engine/simulate.h"
#include "carom/engine/verify.h"
#include "support/engine_cases.h"

namespace carom {
namespace {

using namespace test;

/// A ball whose lowest point is `height` above the cloth.
void add_high_ball(Scene& scene, const std::string& id, double x, double y, double height,
                   const Vec3& v = Vec3::Zero(), const Vec3& w = Vec3::Zero()) {
    add_ball(scene, id, Vec3(x, y, scene.balls.R + height), v, w);
    scene.ball.back().height = height;
}

double scene_radius() {
    return empty_scene().balls.R;
}

std::vector<double> times_of(const Record& record, EventType type) {
    std::vector<double> times;
    for (const Event& e : record.events)
        if (e.type == type) times.push_back(e.time);
    return times;
}

TEST(Airborne, ADroppedBallBouncesUntilItRests) {
    Scene scene = empty_scene();
    add_high_ball(scene, "a", 0.0, 0.0, 0.3);
    const Record r = run_verified(scene);
    const std::vector<double> landings = times_of(r, EventType::kBallCloth);
    ASSERT_EQ(landings.size(), 6u) << "five of them leave the cloth again";
    EXPECT_NEAR(landings[0], 0.247309683414749, 1e-15);
    EXPECT_NEAR(landings[5], 0.726472195030825, 1e-14);
    EXPECT_NEAR(r.state_at(0, 0.5 * (landings[0] + landings[1])).position.z() - scene.balls.R, 0.075, 1e-14);
    EXPECT_NEAR(r.state_at(0, 0.5 * (landings[1] + landings[2])).position.z() - scene.balls.R, 0.01875,
                1e-14);
    EXPECT_EQ(r.stopped, StopReason::kAtRest);
    EXPECT_EQ(r.state_at(0, 1.0).position, Vec3(0.0, 0.0, scene.balls.R));
}

TEST(Airborne, LosslessBouncesRepeatBitForBit) {
    Scene scene = empty_scene();
    scene.balls.e_t = 1.0;
    scene.stop.events = 100000;
    add_ball(scene, "a", Vec3(0.0, 0.0, scene.balls.R), Vec3(0.0, 0.0, 1.5));
    const Record r = simulate(plan_of(scene));
    const std::vector<Segment>& segments = r.tracks[0].segments;
    for (const Segment& s : segments) {
        ASSERT_EQ(s.v.z(), 1.5);
        ASSERT_EQ(s.duration, segments[0].duration);
        ASSERT_EQ(s.r.z(), scene.balls.R);
    }
}

// The checker tolerates the energy that a slow contact of this ball adds, not of a ball of [balls].
TEST(Airborne, SlowContactsOfLargeBalls) {
    for (const double R : {0.05, 0.06, 0.085725, 0.3}) {
        Scene scene = empty_scene();
        scene.table.cushions = {{"rail", {2.0, 1.0}, {-2.0, 1.0}, 0.036576}};
        add_high_ball(scene, "a", 0.0, 0.0, 1e-9);
        BallStart& ball = scene.ball.back();
        ball.own = {R, scene.balls.m * std::pow(R / scene.balls.R, 3.0)};
        ball.position = {0.0, 1.0 - R, R + 1e-9};
        run_verified(scene);
    }
}

// One ball falls into the pocket while another lands on it. They once overlapped by 9 mm because the pair was
// rechecked only when the upper ball lay still.
TEST(Airborne, ABallLandsOnOneFallingIntoAPocket) {
    Scene scene = empty_scene();
    scene.table.pockets = {{"hole", {0.5, 0.0}, 0.2, 0.08}};
    int met = 0;
    for (const double height : {0.001, 0.005, 0.01, 0.02, 0.04}) {
        for (const double speed : {1.0, 2.0, 4.0}) {
            scene.ball.clear();
            add_ball(scene, "falls", Vec3(0.31, 0.0, scene.balls.R), Vec3(-speed, 0.0, 0.0));
            add_high_ball(scene, "flies", 0.2, 0.01, height, Vec3(0.5, 0.0, 0.0));
            const Record record = run_verified(scene);
            met += static_cast<int>(times_of(record, EventType::kBallBall).size());
        }
    }
    EXPECT_GT(met, 10);
}

// mathavan_2010 keeps more speed than the law in space that throws the ball up; hops once gained 15 % energy.
TEST(Airborne, AHopGainsNoEnergy) {
    int hops = 0;
    for (const char* model : {"mathavan_2010", "han_2005", "impulse", "stronge", "smooth"}) {
        for (const double mu_s : {0.0, 0.2}) {
            for (const double height : {0.001, 0.02, 0.036576, 0.04}) {
                Scene scene = empty_scene();
                scene.table.cushions = {{"rail", {2.0, 1.0}, {-2.0, 1.0}, height}};
                scene.balls.mu_s = mu_s;
                scene.balls.e_h = 0.5;
                scene.physics.cushion = cushion_model(model);
                scene.stop.events = 3;
                add_ball(scene, "a", Vec3(0.0, 0.5, scene.balls.R), Vec3(0.4, 6.0, 0.0));
                try {
                    validate(scene);
                } catch (const SceneError&) {
                    continue;  // mathavan_2010 refuses a ball that jams under a high nose
                }
                const Record record = run_verified(scene);
                hops += record.state_at(0, record.events.front().time).state == MotionState::kAirborne;
            }
        }
    }
    EXPECT_GT(hops, 10);
}

// A bouncing ball loses as much speed to the cloth as one that always slides, less the friction of the throw
// upwards.
TEST(Airborne, BouncesBrakeAsSlidingDoes) {
    Scene scene = empty_scene();
    add_ball(scene, "a", Vec3(0.0, 0.0, scene.balls.R), Vec3(4.0, 0.0, 1.5));
    const Record r = run_verified(scene);
    const std::vector<double> landings = times_of(r, EventType::kBallCloth);
    const BallState last = r.state_at(0, landings.back());
    EXPECT_EQ(last.state, MotionState::kSliding);
    const double slid = scene.balls.mu_s * 9.81 * landings.back();
    EXPECT_NEAR(4.0 - last.velocity.x(), slid - scene.balls.mu_s * 1.5,
                2.0 * scene.balls.mu_s * bounce_end(scene.balls.R, 9.81));
}

// In such a low fall, rounding the height is a visible share of the energy.
TEST(Airborne, TinyFallsKeepTheEnergyLaw) {
    for (int k = 1; k <= 200; ++k) {
        Scene scene = empty_scene();
        add_high_ball(scene, "a", 0.0, 0.0, 5e-9 * k);
        run_verified(scene);
    }
}

TEST(Airborne, ABallLandsOnARestingBall) {
    Scene scene = empty_scene();
    const double R = scene.balls.R;
    scene.balls.e_b = 0.95;
    add_ball(scene, "low", 0.0, 0.0);
    add_high_ball(scene, "high", 0.0, 0.0, 2.0 * R + 1.0 / (2.0 * 9.81));
    scene.stop.events = 4;
    const Record r = run_verified(scene);
    ASSERT_EQ(r.events.size(), 4u);
    EXPECT_EQ(r.events[0].type, EventType::kBallBall);
    EXPECT_EQ(r.events[1].type, EventType::kBallCloth);
    EXPECT_EQ(r.events[2].type, EventType::kBallBall);
    EXPECT_EQ(r.events[3].type, EventType::kBallCloth);
    EXPECT_EQ(r.events[3].time, r.events[0].time);
    EXPECT_NEAR(r.tracks[1].segments.back().v.z(), 0.4746875, 1e-14);
    EXPECT_EQ(r.tracks[0].segments.back().v.z(), 0.0);
}

Scene jump(double elevation) {
    Scene scene = empty_scene();
    scene.table = make_table("nine_foot");
    add_ball(scene, "cue", 0.635, 0.5);
    Cue cue;
    cue.mass = 0.25;
    cue.speed = 4.0;
    cue.elevation_deg = elevation;
    cue.height = 0.0;
    cue.restitution = 1.0;
    scene.cue = cue;
    return scene;
}

TEST(Airborne, AJumpShotClearsABall) {
    Scene scene = jump(35.0);
    add_ball(scene, "1", 0.635, 0.5 + 0.428);
    const Record r = run_verified(scene);
    const Event* hit = first(r, EventType::kBallBall);
    const Event* nose = first(r, EventType::kBallCushion);
    ASSERT_NE(nose, nullptr);
    EXPECT_TRUE(hit == nullptr || hit->time > nose->time) << "it flies over the ball";
    Scene drop = scene;
    drop.physics.vertical = Vertical::kDrop;
    const Plan planar_plan = plan_of(drop);
    EXPECT_FALSE(planar_plan.in_force(Effect::kAirborne));
    ASSERT_EQ(planar_plan.warnings.size(), 1u);
    const Record flat = simulate(planar_plan);
    ASSERT_NE(first(flat, EventType::kBallBall), nullptr);
    EXPECT_LT(first(flat, EventType::kBallBall)->time, 0.2);
    EXPECT_EQ(count(flat, EventType::kBallCloth), 0);
}

TEST(Airborne, ASteeperCueMeetsTheBallAgain) {
    EXPECT_TRUE(plan_of(jump(42.0)).warnings.empty());
    ASSERT_EQ(plan_of(jump(43.0)).warnings.size(), 1u);
    EXPECT_NE(plan_of(jump(43.0)).warnings[0].find("rebound from the cloth into the tip"), std::string::npos);
}

TEST(Airborne, ABallLeavesTheTable) {
    Scene scene = empty_scene();
    scene.table = make_table("nine_foot");
    add_high_ball(scene, "a", 0.635, 2.3, 0.02, Vec3(0.0, 4.0, 1.5));
    const Record r = run_verified(scene);
    const Event* out = first(r, EventType::kBallOut);
    ASSERT_NE(out, nullptr);
    EXPECT_EQ(r.stopped, StopReason::kAtRest);
    EXPECT_EQ(r.state_at(0, r.duration).state, MotionState::kOut);
    EXPECT_NEAR(out->time, 0.24 / 4.0, 0.02);
    EXPECT_TRUE(scene_after(scene, r).ball.empty());
}

TEST(Airborne, ABallThatLeftTheTableComesToRestOnTheFloor) {
    Scene scene = empty_scene();
    scene.table = make_table("nine_foot");
    add_high_ball(scene, "a", 0.635, 2.3, 0.02, Vec3(0.0, 4.0, 1.5), Vec3(3.0, 2.0, 1.0));
    add_ball(scene, "b", 0.3, 0.3, 0.0, 2.0);
    const Plan plan = plan_of(scene);
    RunBuffers buffers;
    Outcome outcome;
    Record r;
    simulate(plan, buffers, outcome, r);
    const Event* out = first(r, EventType::kBallOut);
    ASSERT_NE(out, nullptr);
    const double floor = scene.balls.R - kFloorDepth;
    const BallState end = r.state_at(0, r.duration);
    EXPECT_EQ(end.position.z(), floor);
    EXPECT_EQ(end.velocity, Vec3::Zero());
    EXPECT_EQ(end.spin, Vec3::Zero());
    EXPECT_EQ(outcome.balls[0].position, end.position);
    double landed = r.duration;
    for (double t = r.duration; t > out->time; t -= 1e-3) {
        const BallState state = r.state_at(0, t);
        EXPECT_GE(state.position.z(), floor) << t;
        if (state.position.z() == floor) landed = t;
    }
    // Free fall from the point where it crossed the rail.
    const BallState left = r.state_at(0, out->time);
    const double g = r.gravity, up = left.velocity.z(), height = left.position.z() - floor;
    const double falls = (up + std::sqrt(up * up + 2.0 * g * height)) / g;
    EXPECT_NEAR(landed, out->time + falls, 1e-3);
    EXPECT_NEAR(end.position.y(), left.position.y() + 4.0 * falls, 1e-12);
    EXPECT_TRUE(r.orientation_at(0, r.duration).isApprox(r.orientation_at(0, landed), 1e-12));
}

// The cushions are an island without a bed, so a ball that flies over one of them is out.
TEST(Airborne, TheBedDefinesWhereTheTableEnds) {
    Scene scene = empty_scene();
    scene.table = Table();
    for (const auto& [from, to] : {std::pair(Vec2(1.0, 0.0), Vec2(1.0, 1.0)),
                                   {Vec2(1.0, 1.0), Vec2(1.2, 1.0)},
                                   {Vec2(1.2, 1.0), Vec2(1.2, 0.0)}})
        scene.table.cushions.push_back({"", from, to, 0.036});
    scene.table.width = 0.2;
    scene.table.length = 1.0;
    scene.table.corner = Vec2(1.0, 0.0);
    add_high_ball(scene, "a", 0.6, 0.5, 0.2, Vec3(2.0, 0.0, 0.5));
    EXPECT_NE(first(run_verified(scene), EventType::kBallOut), nullptr);

    scene.table.bed = Rectangle(0.0, 0.0, 2.0, 1.0);
    const Record stays = run_verified(scene);
    EXPECT_EQ(first(stays, EventType::kBallOut), nullptr);
    EXPECT_GT(stays.state_at(0, stays.duration).position.x(), 1.2);

    scene.table.bed = Rectangle(0.0, 0.0, 1.1, 1.0);
    const Record leaves = run_verified(scene);
    ASSERT_NE(first(leaves, EventType::kBallOut), nullptr);
    EXPECT_NEAR(first(leaves, EventType::kBallOut)->time, (1.1 - 0.6) / 2.0, 1e-15);
    EXPECT_EQ(leaves.state_at(0, leaves.duration).state, MotionState::kOut);
}

/// A ball that flies from x = 0.2 with velocity v and lands after 0.2 s.
Scene flight_over(const Table& table, const Vec2& v) {
    Scene scene = empty_scene();
    scene.table = table;
    add_high_ball(scene, "a", 0.2, 1.0, 0.2, Vec3(v.x(), v.y(), 0.0));
    return scene;
}

// It once landed inside the jaw, where the table's box has no cloth. A ball that crosses a jaw or cushion is
// out, wherever it would land.
TEST(Airborne, ABallThatCrossesAJawOrCushionIsOut) {
    Table table;
    table.cushions = {{"rail", {0.0, 0.0}, {0.0, 2.0}, 0.036576}};
    table.jaws = {{"post", {0.5, 1.0}, 0.15, 0.036576}};
    for (const bool bed : {false, true}) {
        if (bed) table.bed = Rectangle(-10.0, -10.0, 10.0, 10.0);
        for (const double speed : {0.9, 1.0, 1.2, 1.5, 2.0, 2.2, 2.3, 4.0}) {
            const Record r = run_verified(flight_over(table, {speed, 0.0}));
            ASSERT_EQ(count(r, EventType::kBallOut), 1) << speed;
            EXPECT_NEAR(first(r, EventType::kBallOut)->time, 0.15 / speed, 1e-12) << speed;
            EXPECT_EQ(count(r, EventType::kBallCloth), 0) << speed;
        }
        // From outside, it meets the nose before it lands.
        const Record meets = run_verified(flight_over(table, {0.74, 0.0}));
        EXPECT_EQ(meets.events[0].type, EventType::kBallJaw);
        // A bed has cloth on both sides of a cushion.
        const Record over = run_verified(flight_over(table, {-4.0, 0.0}));
        EXPECT_EQ(count(over, EventType::kBallOut), bed ? 0 : 1);
        EXPECT_EQ(first(over, EventType::kBallCloth) != nullptr, bed);
    }
    // A post of radius 0 is met, and there is nothing behind it.
    table.jaws[0].radius = 0.0;
    EXPECT_NE(first(run_verified(flight_over(table, {1.4, 0.0})), EventType::kBallJaw), nullptr);
    EXPECT_EQ(first(run_verified(flight_over(table, {2.5, 0.0})), EventType::kBallJaw), nullptr);
}

// Records of such flights from before the fix break a law.
TEST(Airborne, TheCheckerRejectsFlightsIntoWalls) {
    const struct {
        const char* says;
        std::vector<Cushion> cushions;
        std::vector<Jaw> jaws;
    } cases[] = {
        {"behind the nose of a jaw", {}, {{"post", {0.5, 1.0}, 0.15, 0.036576}}},
        {"flies on behind a cushion", {{"rail", {0.4, 0.0}, {0.4, 2.0}, 0.036576}}, {}},
    };
    for (const auto& c : cases) {
        Table walls;
        walls.cushions = c.cushions;
        walls.jaws = c.jaws;
        const Record open = simulate(plan_of(flight_over(Table(), {1.5, 0.0})));
        const auto violation = verify(open, plan_of(flight_over(walls, {1.5, 0.0})));
        ASSERT_TRUE(violation) << c.says;
        EXPECT_EQ(violation->law, "U3");
        EXPECT_NE(violation->message.find(c.says), std::string::npos) << violation->message;
    }
}

TEST(Airborne, ABedNeedsNoCushions) {
    Scene scene = empty_scene();
    scene.table.bed = Rectangle(-1.0, -1.0, 1.0, 1.0);
    add_high_ball(scene, "a", 0.6, 0.5, 0.2, Vec3(0.0, 2.0, 0.5));
    const Record r = run_verified(scene);
    ASSERT_NE(first(r, EventType::kBallOut), nullptr);
    EXPECT_NEAR(first(r, EventType::kBallOut)->time, 0.25, 1e-15);
}

// Beyond the bed but over a pocket, the pocket's far edge decides.
TEST(Airborne, APocketReachesBeyondTheBed) {
    Scene scene = empty_scene();
    scene.table.pockets = {{"", Vec2(0.99, 0.5), 0.06, 0.1}};
    scene.table.bed = Rectangle(0.0, 0.0, 1.0, 1.0);
    add_high_ball(scene, "a", 0.6, 0.5, 0.3, Vec3(5.0, 0.0, 0.3));
    const Record high = run_verified(scene);
    ASSERT_NE(first(high, EventType::kBallOut), nullptr);
    EXPECT_NEAR(first(high, EventType::kBallOut)->time, 0.45 / 5.0, 1e-12);
    scene.ball[0].velocity.z() = -2.85;
    const Record low = run_verified(scene);
    EXPECT_EQ(first(low, EventType::kBallOut), nullptr);
    EXPECT_EQ(count(low, EventType::kBallPocket), 1);
}

TEST(Airborne, ABallFliesIntoAPocket) {
    Scene scene = empty_scene();
    scene.table = make_table("nine_foot");
    const Pocket& corner =
        *std::max_element(scene.table.pockets.begin(), scene.table.pockets.end(),
                          [](const Pocket& p, const Pocket& q) { return p.center.sum() < q.center.sum(); });
    const Vec2 from(corner.center.x() - 0.4, corner.center.y() - 0.4);
    // It lands in the middle of the pocket.
    const double t = 0.2;
    const Vec2 v = (corner.center - from) / t;
    add_high_ball(scene, "a", from.x(), from.y(), 0.0, Vec3(v.x(), v.y(), 0.5 * 9.81 * t));
    const Record r = run_verified(scene);
    EXPECT_EQ(count(r, EventType::kBallPocket), 1);
    EXPECT_NEAR(first(r, EventType::kBallPocket)->time, t, 1e-12);
}

TEST(Airborne, ACushionThrowsABallUp) {
    Scene scene = empty_scene();
    scene.table = box(1.0, 2.0, 1.28 * scene.balls.R);
    add_ball(scene, "a", 0.5, 1.0, 0.0, 4.0);
    scene.balls.mu_s = 1e-9;
    scene.stop.time = 0.6;
    scene.physics.cushion = &kHan2005;
    EXPECT_FALSE(plan_of(scene).in_force(Effect::kAirborne));
    const Record flat = run_verified(scene);
    scene.balls.e_h = 0.2;
    EXPECT_TRUE(plan_of(scene).in_force(Effect::kAirborne));
    const Record r = run_verified(scene);
    const Event* nose = first(r, EventType::kBallCushion);
    ASSERT_NE(nose, nullptr);
    const BallState after = r.state_at(0, nose->time), level = flat.state_at(0, nose->time);
    EXPECT_EQ(after.state, MotionState::kAirborne);
    EXPECT_GT(after.velocity.z(), 0.2);
    EXPECT_EQ(after.velocity.y(), level.velocity.y()) << "the horizontal part is that of the model";
}

TEST(Airborne, TwoStepLiftsTheCueBallOfAFullHit) {
    Scene scene = empty_scene();
    scene.balls.mu_b = 0.05;
    scene.balls.e_b = 0.95;
    scene.balls.mu_s = 0.2;
    scene.physics.ball_ball = ball_ball_model("two_step");
    add_ball(scene, "cue", 0.0, 0.0, 2.0, 0.0, rolling_spin(2.0, 0.0, scene.balls.R));
    add_ball(scene, "1", 0.5, 0.0);
    const Record r = run_verified(scene);
    const Event* hit = first(r, EventType::kBallBall);
    ASSERT_NE(hit, nullptr);
    const BallState cue = r.state_at(0, hit->time);
    EXPECT_EQ(cue.state, MotionState::kAirborne);
    EXPECT_NEAR(cue.velocity.z() / cue.velocity.x(), 0.0975 / 0.05, 0.02);
    scene.balls.mu_b = 0.0;
    EXPECT_FALSE(plan_of(scene).in_force(Effect::kAirborne)) << "without friction, and alike, nothing lifts";
}

TEST(Airborne, UnlikeBallsWithFriction) {
    Scene scene = empty_scene();
    add_ball(scene, "cue", 0.0, 0.0, 2.0, 0.0);
    add_ball(scene, "1", 0.5, 0.0);
    scene.ball[0].own = BallSize{0.0301, 0.199};
    scene.ball[0].position.z() = 0.0301;
    for (const char* model : {"mathavan", "two_step"}) {
        scene.physics.ball_ball = ball_ball_model(model);
        validate(scene);
        run_verified(scene);
    }
    scene.physics.ball_ball = ball_ball_model("inelastic");
    EXPECT_THROW(validate(scene), SceneError);
}

// A ball above the hollow of three.
Scene pile(double drop, double off) {
    Scene scene = empty_scene();
    const double R = scene.balls.R, s = R * 2.0 / std::sqrt(3.0);
    for (int k = 0; k < 3; ++k) {
        const SinCos at = sin_cos_deg(120.0 * k);
        add_ball(scene, std::to_string(k), s * 1.0001 * at.cos, s * 1.0001 * at.sin);
    }
    const double rise = std::sqrt(4.0 * R * R - s * s * 1.0002);
    add_high_ball(scene, "top", off, 0.3 * off, rise + drop + off + 1e-9);
    return scene;
}

// Balls set gently into the hollow of three, on top of two, or dropped on them: slow contacts end.
TEST(Airborne, Piles) {
    for (const double drop : {0.0, 1e-6, 0.01, 0.2}) {
        for (const double off : {0.0, 1e-6, 1e-3}) {
            const Scene scene = pile(drop, off);
            const Record r = run_verified(scene);
            EXPECT_EQ(r.stopped, StopReason::kAtRest);
            EXPECT_LT(r.events.size(), 20000u) << drop << " " << off;
            EXPECT_EQ(r.tracks[3].segments.back().r.z(), scene.balls.R);
        }
    }
}

// Energy rises only in marked events; the record without the marks breaks the law.
TEST(Airborne, SlowContactsAreMarked) {
    const Scene scene = pile(0.0, 1e-3);
    Record r = run_verified(scene);
    const auto marks = std::count_if(r.events.begin(), r.events.end(), [](const Event& e) { return e.slow; });
    EXPECT_GT(marks, 0);
    EXPECT_LT(marks, static_cast<std::ptrdiff_t>(r.events.size()));
    EXPECT_EQ(parse_record(record_json(r), "(test)").events, r.events);
    for (Event& e : r.events) e.slow = false;
    const auto violation = verify(r, plan_of(scene));
    ASSERT_TRUE(violation.has_value());
    EXPECT_EQ(violation->law, "U4");
}

// Balls exactly above each other or above a nose tremble forever, which is an error.
TEST(Airborne, EndlessBalancingIsAnError) {
    const double D = 2.0 * scene_radius();
    struct Case {
        const char* words;
        std::vector<Vec3> balls;  // x, y, height
        double rail = 1.0;        // y of a cushion
    };
    const Case cases[] = {
        {"balls 0 and 1 balance on each other", {{0.0, 0.0, 0.0}, {0.0, 0.0, D + 0.01}}},
        {"balance on each other", {{0.0, 0.0, 0.0}, {0.0, 0.0, D}, {0.0, 0.0, 2.0 * D}}},
        {"balance on each other", {{0.0, 0.0, 0.0}, {0.0, 0.0, D + 0.02}, {0.0, 0.0, 2.0 * D + 0.03}}},
        {"balance on each other", {{0.0, 0.0, 0.0}, {0.0, 0.0, D}, {1.0, 0.0, 0.0}, {1.0, 0.0, D}}},
        {"ball 0 balances on a cushion or a jaw", {{0.0, 0.5, 0.2}}, 0.5},
        {"balance", {{0.0, 0.5, 0.2}, {0.0, 0.5, 0.2 + 2.0 * D}}, 0.5},
    };
    for (const Case& c : cases) {
        Scene scene = empty_scene();
        scene.table.cushions = {{"rail", {2.0, c.rail}, {-2.0, c.rail}, 0.036576}};
        for (const Vec3& b : c.balls)
            add_high_ball(scene, std::to_string(scene.ball.size()), b.x(), b.y(), b.z());
        try {
            const Record record = simulate(plan_of(scene));
            ADD_FAILURE() << c.words << ": it ended";
        } catch (const SimulationError& error) {
            EXPECT_NE(std::string(error.what()).find(c.words), std::string::npos) << error.what();
        }
    }
}

// Results are continuous in a ball's height: compares 1e-3 m, 1e-6 m, ... above the cloth with 0.
TEST(Airborne, ResultsAreContinuousInTheHeight) {
    const auto after = [](double height) {
        Scene scene = empty_scene();
        scene.physics.ball_ball = ball_ball_model("two_step");
        scene.stop.time = 0.5;
        add_high_ball(scene, "a", 0.0, 0.0, height, Vec3(3.0, 0.0, 0.0), Vec3(0.0, 50.0, 20.0));
        // So close that it cannot fall before it arrives.
        const double R = scene_radius();
        add_ball(scene, "b", std::sqrt(4.0 * R * R - 1e-4) + 1e-9, 0.01);
        const Record r = simulate(plan_of(scene));
        const Event* hit = first(r, EventType::kBallBall);
        EXPECT_NE(hit, nullptr);
        return r.state_at(1, hit->time);
    };
    const BallState lies = after(0.0);
    for (double height = 1e-4; height > 1e-12; height *= 0.1) {
        const BallState s = after(height);
        EXPECT_LE((s.velocity - lies.velocity).norm(), 1e-9 + 400.0 * height) << height;
        EXPECT_LE(scene_radius() * (s.spin - lies.spin).norm(), 1e-9 + 400.0 * height) << height;
    }
}

// Plastic balls that meet at metres per second have the friction of any restitution, (A5); it was once 0.
TEST(Airborne, PlasticBallsHaveFriction) {
    Scene scene = empty_scene();
    scene.balls.e_b = 0.0;
    scene.balls.mu_b = 0.3;
    const double R = scene.balls.R;
    add_high_ball(scene, "a", 0.0, 0.0, 0.5, Vec3(2.0, 0.0, 0.0), Vec3(0.0, 0.0, 100.0));
    add_high_ball(scene, "b", 0.1, 0.0, 0.5);
    scene.stop.events = 1;
    const Record record = run_verified(scene);
    ASSERT_EQ(count(record, EventType::kBallBall), 1);
    // Both fall equally: v_n = 2 m/s, and ending the slip R w of 2.9 m/s would need more than mu_b J_n.
    const Vec3 wa = record.tracks[0].segments.back().w, wb = record.tracks[1].segments.back().w;
    const double turn = 2.5 / R * std::min(0.3 * 0.5 * 2.0, 2.0 / 7.0 * 0.5 * R * 100.0);
    EXPECT_NEAR(wa.z(), 100.0 - turn, 0.02 * turn);
    EXPECT_NEAR(wb.z(), -turn, 0.02 * turn);
}

}  // namespace
}  // namespace carom
