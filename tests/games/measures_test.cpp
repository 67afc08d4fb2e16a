// Measures and expressions: against the record, and their refusals.
#include "carom/games/measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <variant>

#include "carom/games/shot.h"
#include "support/engine_cases.h"
#include "support/files.h"

namespace carom::test {
namespace {

using games::Measure;
using games::MeasureError;
using games::text_of;

Scene scene_named(const std::string& name) {
    return read_scene(std::string(CAROM_SOURCE_DIR) + "/scenes/" + name + ".toml");
}

std::string asked(const std::string& text, const Scene& scene, const Record& record) {
    return text_of(Measure(text, scene, &games::kEightBall).of(record));
}

TEST(Measures, DescribeAShot) {
    const Scene scene = scene_named("draw");
    const Record record = simulate(plan_of(scene));
    const auto is = [&](const std::string& text, const std::string& value) {
        EXPECT_EQ(asked(text, scene, record), value) << text;
    };
    is("pocketed", "1");
    is("pockets", "p3");
    is("pocket_of(1)", "p3");
    is("pocket_of(cue)", "");
    is("balls_pocketed", "1");
    is("any_pocketed and not scratch", "1");
    is("scratch", "0");
    is("\"1\" in pocketed", "1");
    is("\"cue\" in pocketed or 1 > 2", "0");
    is("first_hit == \"1\"", "1");
    is("pocket_of(1) == \"p3\" and duration < 4", "1");
    is("cushions", "");
    is("cushion_x(1)", "");
    is("cue near (0.748, 1.792, 0.001)", "1");
    is("cue near (0.748, 1.992)", "0");
    is("\"cue\" near (0.7, 1.8)", "1");
    is("distance(1, 0, 0)", "");
    is("air_time(cue)", "0");
    is("2 + 3 * -2 - 4 / 2", "-6");
    is("(2 + 3) * 2", "10");
    is("max_speed(cue) > 2.2 and max_speed(cue) < 2.4", "1");
}

TEST(Measures, CushionsOfTheStruckBallInOrder) {
    const Scene scene = scene_named("three_cushion");
    const Record record = simulate(plan_of(scene));
    EXPECT_EQ(asked("foul(three_cushion)", scene, record), "");
    EXPECT_EQ(asked("cushion_diamond(1) > 0 and cushion_diamond(1) < 4", scene, record), "1");
    const std::string list = asked("cushions", scene, record);
    EXPECT_EQ(std::count(list.begin(), list.end(), ';'), 3);
    EXPECT_EQ(asked("cushion_y(5)", scene, record), "");
}

TEST(Measures, TheRouteOfAShotAndItsPoints) {
    const Scene scene = scene_named("three_cushion");
    const Record record = simulate(plan_of(scene));
    const auto is = [&](const std::string& text, const std::string& value) {
        EXPECT_EQ(asked(text, scene, record), value) << text;
    };
    is("route", "head;right;left;foot");
    is("route == \"head, right, left, foot\"", "1");
    is("\"foot\" in route and not (\"foot\" == route)", "1");
    is("cushions_before(yellow)", "0");
    is("cushions_before(red)", "4");
    is("cushions_before_first", "0");
    is("cushions_between", "4");
    is("carom and not kick and not bank and not combination", "1");
    for (const char* game : {"three_cushion", "one_cushion", "straight_rail"})
        is(std::string("point(") + game + ")", "1");
    EXPECT_THROW(asked("\"top\" in route", scene, record), MeasureError);
    // The ball meets nothing.
    Scene alone = scene;
    alone.ball.resize(1);
    const Record miss = simulate(plan_of(alone));
    EXPECT_EQ(asked("cushions_before_first", alone, miss), "");
    EXPECT_EQ(asked("kick or carom", alone, miss), "0");
}

// The cue ball reaches ball 1 off the head rail; ball 2 goes off a rail into a corner; ball 3 pushes ball 4.
TEST(Measures, KicksBanksAndCombinations) {
    const auto shot = [](const std::string& balls) {
        return parse_scene("[table]\npreset = \"nine_foot\"\n" + balls, "shot.toml");
    };
    const Scene kick = shot(
        "[[ball]]\nposition = [0.635, 0.6]\n[[ball]]\nid = \"1\"\nposition = [0.635, 0.9]\n"
        "[cue]\nspeed = 2\naim_deg = 270\noffset = [0, 0]\n");
    const Record kicked = simulate(plan_of(kick));
    EXPECT_EQ(asked("kick and cushions_before(1) == 1", kick, kicked), "1");
    EXPECT_EQ(asked("route", kick, kicked).substr(0, 4), "head");
    EXPECT_EQ(asked("bank or combination or carom", kick, kicked), "0");
    const Scene both = shot(
        "[[ball]]\nposition = [0.635, 2.0]\n[cue]\nspeed = 0.2\naim_deg = 0\noffset = [0, 0]\n"
        "[[ball]]\nid = \"3\"\nposition = [1.0, 2.27]\nvelocity = [1.5, 1.5]\n"
        "[[ball]]\nid = \"4\"\nposition = [1.16, 2.43]\n");
    const Record combined = simulate(plan_of(both));
    EXPECT_EQ(asked("\"4\" in pocketed and combination and not bank", both, combined), "1");
    const Scene bank = read_scene(std::string(CAROM_SOURCE_DIR) + "/scenes/side_bank.toml");
    EXPECT_EQ(asked("bank and not combination and not kick", bank, simulate(plan_of(bank))), "1");
}

TEST(Measures, TravelMatchesTheSampledPath) {
    for (const char* name : {"three_cushion", "eight_ball_break", "jump", "masse"}) {
        SCOPED_TRACE(name);
        const std::string path = std::string(CAROM_SOURCE_DIR) + "/scenes/" + name + ".toml";
        if (!std::filesystem::exists(path)) continue;
        const Scene scene = read_scene(path);
        const Record record = simulate(plan_of(scene));
        const int ball = games::index_of(record, scene.cue->ball);
        double sum = 0.0, top = 0.0;
        Vec3 last = record.state_at(ball, 0.0).position;
        const int steps = 200000;
        for (int k = 1; k <= steps; ++k) {
            const BallState s = record.state_at(ball, record.duration * k / steps);
            if (is_gone(s.state)) break;
            sum += std::hypot(s.position.x() - last.x(), s.position.y() - last.y());
            top = std::max(top, s.velocity.norm());
            last = s.position;
        }
        const auto number = [&](const std::string& what) {
            return std::get<double>(Measure(what + "(" + scene.cue->ball + ")", scene).of(record));
        };
        EXPECT_NEAR(number("travel"), sum, 1e-4 * sum);
        EXPECT_NEAR(number("max_speed"), top, 1e-2 * top);
        EXPECT_LE(number("rest_time"), record.duration);
    }
}

TEST(Measures, BreaksAreJudgedByTheirGame) {
    const Scene scene = scene_named("eight_ball_break");
    const Record record = simulate(plan_of(scene));
    EXPECT_EQ(asked("legal_break(eight_ball)", scene, record), "1");
    EXPECT_EQ(asked("break_foul(eight_ball)", scene, record), "");
    EXPECT_EQ(asked("driven >= 4", scene, record), "1");
    // Without the game's balls there is no verdict.
    const Scene two = scene_named("draw");
    EXPECT_THROW(asked("foul", two, simulate(plan_of(two))), std::invalid_argument);
}

// The head string of this table is at y = 0.635. Ball 1 crosses it, ball 2 falls, ball 3 stays, and the
// struck ball does not count.
TEST(Measures, CountBallsThatFellOrCrossedTheHeadString) {
    const Scene scene = parse_scene(
        "[table]\npreset = \"nine_foot\"\n[[ball]]\nposition = [0.635, 0.3]\n[cue]\nspeed = 0.2\naim_deg = "
        "180\n"
        "[[ball]]\nid = \"1\"\nposition = [0.3, 1.2]\nvelocity = [0, -2]\n"
        "[[ball]]\nid = \"2\"\nposition = [1.2, 2.47]\nvelocity = [1, 1]\n"
        "[[ball]]\nid = \"3\"\nposition = [0.9, 1.0]\nvelocity = [0, -0.1]\n",
        "h.toml");
    const Record record = simulate(plan_of(scene));
    EXPECT_EQ(asked("pocketed", scene, record), "2");
    EXPECT_EQ(asked("past_head_string", scene, record), "2");
}

TEST(Measures, MistakesAreLocated) {
    const Scene scene = scene_named("draw");
    const auto refused = [&](const std::string& text, const std::string& why) {
        try {
            const Measure taken(text, scene);
            FAIL() << text << " is taken";
        } catch (const MeasureError& error) {
            EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
        }
    };
    refused("", "at its end: expected a measure");
    refused("pocketed and", "at its end: expected a measure");
    refused("potted", "carom describe measures");
    refused("travel", "expected travel(BALL)");
    refused("travel(7)", "the scene has no ball \"7\"");
    refused("travel(cue, 1)", "expected travel(BALL)");
    refused("cushion_x(0)", "from 1 to 1000");
    refused("cushion_x(cue)", "expected a number");
    refused("foul", "expected foul(GAME)");
    refused("foul(chess)", "no game \"chess\"; expected one of eight_ball");
    refused("pocketed < 3", "expected numbers beside <");
    refused("pocketed + 1", "expected numbers beside +");
    refused("\"1", "closing quote");
    refused("cue near 1", "expected (");
    refused("cue near (1)", "expected (X, Y)");
    refused("duration duration", "expected the end");
    refused("1 $ 2", "expected the end");
    refused(std::string(500, '(') + "1", "fewer levels");
    refused("not " + std::string(400, ' ') + std::string(100, '('), "fewer levels");
}

// The corner-five system: from the corner, number 5, with running side and aimed at diamond D behind the
// nose, the ball meets its third cushion near 5 - D. Both are counted from the far end.
TEST(Measures, TheCornerFiveSystemHolds) {
    for (const double aimed : {1.5, 2.0, 2.5, 3.0, 3.5}) {
        const Scene scene = parse_scene(
            "[table]\npreset = \"carom\"\n[balls]\npreset = \"carom\"\n[[ball]]\nid = \"white\"\n"
            "position = [0.0689, 0.0887]\n[cue]\nball = \"white\"\nspeed = 4.0\noffset = [0.4, 0.0]\n"
            "aim_at = [1.515, " +
                std::to_string(2.84 * (8.0 - aimed) / 8.0) + "]\n",
            "corner five");
        const Record record = simulate(plan_of(scene));
        const double third = std::get<double>(Measure("cushion_diamond(3)", scene).of(record));
        EXPECT_NEAR(8.0 - third, 5.0 - aimed, 0.4) << aimed;
    }
}

}  // namespace
}  // namespace carom::test
