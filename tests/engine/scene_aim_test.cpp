// Aims in players' terms, and numbers with units.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "carom/engine/event_details.h"
#include "carom/engine/strike.h"
#include "carom/engine/variation.h"
#include "support/engine_cases.h"
#include "support/scene_errors.h"

namespace carom::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

std::string scene_with(const std::string& cue, const std::string& more = "") {
    return "[table]\npreset = \"nine_foot\"\n" + more +
           "[[ball]]\nid = \"cue\"\nposition = [0.4, 0.5]\n"
           "[[ball]]\nid = \"1\"\nposition = [0.9, 1.3]\n[cue]\noffset = [0, 0]\n" +
           cue;
}

Cue cue_of(const std::string& cue, const std::string& more = "") {
    return parse_scene(scene_with(cue, more), "aim.toml").cue.value();
}

/// The first contact, without squirt.
EventDetails first_contact(const std::string& aim) {
    const Scene scene = parse_scene(scene_with("speed = 2\nend_mass = 0\n" + aim), "aim.toml");
    const Record record = simulate(plan_of(scene));
    for (std::size_t i = 0; i < record.events.size(); ++i)
        if (record.events[i].type == EventType::kBallBall) return details_of(record, i);
    ADD_FAILURE() << aim << " hits nothing";
    return {};
}

TEST(SceneAim, PlacesAndBalls) {
    const double towards = std::atan2(0.8, 0.5) / kDegree;
    EXPECT_NEAR(cue_of("aim_at = \"1\"\n").aim_deg, towards, 1e-12);
    EXPECT_NEAR(cue_of("aim_at = [0.9, 1.3]\n").aim_deg, towards, 1e-12);
    EXPECT_NEAR(cue_of("aim_at = [\"90 cm\", 1.3]\n").aim_deg, towards, 1e-12);
    EXPECT_NEAR(cue_of("aim_diamond = [\"head\", 4]\n").aim_deg, std::atan2(-0.5, 0.87) / kDegree, 1e-12);
    EXPECT_NEAR(cue_of("aim_diamond = [\"left\", 4]\n").aim_deg, std::atan2(0.77, -0.4) / kDegree, 1e-12);
    EXPECT_NEAR(cue_of("aim_diamond = [\"foot\", 2.5]\n").aim_deg,
                std::atan2(2.04, 2.5 / 4.0 * 1.27 - 0.4) / kDegree, 1e-12);
}

TEST(SceneAim, AHitHasItsStatedFullness) {
    EXPECT_NEAR(first_contact("aim_hit = [\"1\", 1]\n").cut, 0.0, 1e-6);
    for (const double full : {0.75, 0.5, 0.25, -0.25, -0.5, -0.75}) {
        const EventDetails d = first_contact("aim_hit = [\"1\", " + std::to_string(full) + "]\n");
        EXPECT_NEAR(std::sin(d.cut), 1.0 - std::abs(full), 1e-6) << full;
        // The cue ball passes on the hit side: if that is left, the z of v x n is positive.
        const Vec3 v = d.balls[0].before.velocity, to_object = -d.normal;
        EXPECT_EQ(v.cross(to_object).z() < 0.0, full > 0.0) << full;
    }
}

TEST(SceneAim, AGhostBallSendsTheBallToThePocket) {
    const Scene scene =
        parse_scene(scene_with("speed = 2\nend_mass = 0\nghost = [\"1\", \"p4\"]\n"), "aim.toml");
    const EventDetails d = first_contact("ghost = [\"1\", \"p4\"]\n");
    const Vec2 line = (scene.table.pockets[3].center - Vec2(0.9, 1.3)).normalized();
    EXPECT_NEAR(planar(d.normal).dot(line), -1.0, 1e-9);
}

TEST(SceneAim, BallSpeedIsTheBallsSpeed) {
    const Scene scene = parse_scene(scene_with("ball_speed = 3.5\naim_at = \"1\"\n"), "aim.toml");
    const Record record = simulate(plan_of(scene));
    EXPECT_NEAR(details_of(record, 0).balls[0].after.velocity.norm(), 3.5, 1e-12);
    EXPECT_NEAR(cue_of("ball_speed = \"20 mph\"\n").speed / cue_of("ball_speed = 8.9408\n").speed, 1.0,
                1e-15);
}

TEST(SceneAim, UnitsConvertToPlainNumbers) {
    const auto radius = [](const std::string& text) {
        return parse_scene("[balls]\nradius = " + text + "\n[[ball]]\n", "r.toml").balls.R;
    };
    EXPECT_EQ(radius("\"28.575 mm\""), 0.028575);
    EXPECT_EQ(radius("\"2.8575 cm\""), 0.028575);
    EXPECT_EQ(radius("\"0.028575 m\""), 0.028575);
    EXPECT_EQ(radius("\"28.575mm\""), 0.028575);
    EXPECT_NEAR(radius("\"1.125 in\""), 0.028575, 1e-17);
    EXPECT_EQ(parse_scene("[balls]\nmass = \"170 g\"\n[[ball]]\n", "m.toml").balls.m, 0.170);
    EXPECT_NEAR(cue_of("aim_deg = \"1.5707963267948966 rad\"\n").aim_deg, 90.0, 1e-13);
    EXPECT_EQ(cue_of("speed = \"9 km/h\"\n").speed, 2.5);
}

TEST(SceneAim, AimsFollowVaryingBalls) {
    // Fast and slow path agree: the aim follows the ball.
    const Variation places = Variation::from_text(scene_with("aim_at = \"1\"\n"), "v.toml",
                                                  {"ball.1.position.x=uniform(0.5,1.1)"}, 1);
    for (std::uint64_t i = 0; i < 20; ++i) {
        const VariedShot shot = places.shot(i);
        const Scene scene = shot.scene.value();
        const Vec2 way = planar(scene.ball[1].position - scene.ball[0].position);
        EXPECT_NEAR(scene.cue->aim_deg, std::atan2(way.y(), way.x()) / kDegree, 1e-12);
        Scene quick = places.base();
        EXPECT_FALSE(places.put(shot.values, quick));
    }
    // A rule for the aim replaces it.
    const Variation aims =
        Variation::from_text(scene_with("aim_at = \"1\"\n"), "v.toml", {"cue.aim_deg=normal(0.5)"}, 1);
    EXPECT_NEAR(aims.shot(0).scene.value().cue->aim_deg, aims.base().cue->aim_deg, 3.0);
}

/// A ball frozen to the left rail, struck away from it.
Scene from_the_rail(const std::string& cue) {
    return parse_scene("[[ball]]\nposition = [0.028575, 1.0]\n[cue]\naim_deg = 0\nspeed = 3\n" + cue,
                       "aim.toml");
}

// The cue's axis passes through the centre at R sin(e) - (h - R) cos(e) above the nose, measured across it;
// that equals the cue's radius there.
TEST(CueRoom, ACueClearsTheNoseThatItCrosses) {
    const Scene scene = from_the_rail("offset = [0, 0]\n");
    const double R = scene.balls.R, h = scene.table.cushions.front().height;
    const auto clears = [&](double deg) {
        const double sin = std::sin(deg * kDegree), cos = std::cos(deg * kDegree);
        const double thick = 0.0065 + 0.008 / 1.473 * R * (1.0 - cos) / cos;
        return R * sin - (h - R) * cos >= thick;
    };
    const CueRoom room = room_for(scene, *scene.cue);
    EXPECT_EQ(room.in.substr(0, 8), "cushion ");
    ASSERT_TRUE(room.clears_deg);
    EXPECT_TRUE(clears(*room.clears_deg)) << *room.clears_deg;
    EXPECT_FALSE(clears(*room.clears_deg - 0.1)) << *room.clears_deg;
    EXPECT_EQ(from_the_rail("offset = [0, 0]\nelevation_deg = \"auto\"\n").cue->elevation_deg,
              *room.clears_deg);
    EXPECT_NE(room_note(scene).find("would reach into cushion"), std::string::npos) << room_note(scene);
    EXPECT_EQ(room_note(from_the_rail("offset = [0, 0]\nelevation_deg = 60\n")), "");
    EXPECT_EQ(room_note(parse_scene(scene_with("speed = 2\n"), "aim.toml")), "") << "nearly level";
    EXPECT_EQ(room_note(parse_scene("[[ball]]\nposition = [0.028575, 1.0]\n[cue]\nspeed = 0\naim_deg = 0\n",
                                    "aim.toml")),
              "");
}

TEST(CueRoom, ABallBehindBlocksTheCue) {
    const std::string balls =
        "[table]\ncushion = []\n[[ball]]\nposition = [0, 0]\n[[ball]]\nid = \"7\"\nposition = [-0.1, "
        "0]\n[cue]\naim_deg = 0\noffset = [0, 0]\n";
    const Scene scene = parse_scene(balls, "aim.toml");
    const CueRoom room = room_for(scene, *scene.cue);
    EXPECT_EQ(room.in, "ball 7");
    // The axis passes the other centre at R + r.
    const double R = scene.balls.R;
    ASSERT_TRUE(room.clears_deg);
    EXPECT_NEAR(0.1 * std::sin(*room.clears_deg * kDegree), R + 0.0065 + 0.008 / 1.473 * (0.1 - R), 3e-4);
    // A jaw and a round wall also block the cue.
    const std::string wall =
        "[table]\ncushion = []\n[[table.arc]]\ncenter = [0, 0]\nradius = 0.05\n[[ball]]\nposition = [0, "
        "0]\n[physics]\nvertical = \"drop\"\n[cue]\n";
    const Scene round = parse_scene(wall, "aim.toml");
    EXPECT_EQ(room_for(round, *round.cue).in, "arc a1");
    const Scene post = parse_scene(
        "[table]\njaw = [{ center = [-0.1, 0], radius = 0.02 }]\n[[ball]]\nposition = [0, 0]\n[cue]\naim_deg "
        "= 0\n",
        "aim.toml");
    EXPECT_EQ(room_for(post, *post.cue).in, "jaw j1");
    // A ball of 60 cm blocks the cue at any elevation.
    const std::string giant =
        "[table]\ncushion = []\n[balls]\nmu_b = 0\n[physics]\nball_ball = \"elastic\"\n[[ball]]\nposition = "
        "[0, 0]\n"
        "[[ball]]\nid = \"2\"\nposition = [0, -0.2]\nradius = 0.3\n[cue]\naim_deg = 90\n";
    const Scene blocked = parse_scene(giant, "aim.toml");
    EXPECT_FALSE(room_for(blocked, *blocked.cue).clears_deg);
    EXPECT_NE(room_note(blocked).find("no elevation clears it"), std::string::npos);
    EXPECT_NE(error_of(giant + "elevation_deg = \"auto\"\n").find("no elevation keeps the cue out of ball 2"),
              std::string::npos);
}

}  // namespace
}  // namespace carom::test
