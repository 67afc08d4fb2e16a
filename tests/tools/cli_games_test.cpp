// carom judge, next and advise: a match from the shell, refused states, and advice.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "carom/engine/scene.h"
#include "cli.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

class CliGames : public ::testing::Test {
  protected:
    std::string file(const std::string& name) const { return folder_.file(name); }
    TemporaryFolder folder_;
    const std::string break_ = CAROM_SOURCE_DIR "/scenes/nine_ball_break.toml";
};

TEST_F(CliGames, AMatchIsPlayedByTwoCommands) {
    std::string scene = break_;
    std::vector<std::string> state = {"--game", "nine_ball"};
    int shots = 0;
    for (; shots < 12; ++shots) {
        const std::string next = file(std::to_string(shots) + ".toml"),
                          after = file(std::to_string(shots) + ".json");
        std::vector<std::string> arguments = {"next", scene, "-o", next, "--state-out", after};
        arguments.insert(arguments.end(), state.begin(), state.end());
        const ProcessResult result = carom(arguments);
        if (result.status == 2 && contains(result.err, "the game is over")) break;
        ASSERT_EQ(result.status, 0) << result.err;
        const Json read = Json::parse(read_file(after));
        EXPECT_EQ(read.at("game"), "nine_ball");
        const std::string text = read_file(next);
        EXPECT_TRUE(contains(text, "player " + std::to_string(read.at("turn").get<int>() + 1) + " shoots"))
            << text;
        // The output is a playable scene.
        ASSERT_EQ(carom({"check", next}).status, 0);
        scene = next;
        state = {"--state", after};
    }
    EXPECT_GE(shots, 3);
}

TEST_F(CliGames, ALessAccuratePlayerMakesAndWinsLess) {
    const std::string far = folder_.write("far.toml",
                                          "[table]\npreset = \"nine_foot\"\n"
                                          "[[ball]]\nid = \"cue\"\nposition = [0.6, 0.4]\n"
                                          "[[ball]]\nid = \"3\"\nposition = [0.8, 1.6]\n"
                                          "[[ball]]\nid = \"8\"\nposition = [0.2, 1.3]\n");
    const auto best = [&](const std::string& hand) {
        const ProcessResult told =
            carom({"advise", far, "--skill", "club", "--best", "1", "--json", "--hand", hand});
        EXPECT_EQ(told.status, 0) << told.err;
        return Json::parse(told.out).at(0);
    };
    const Json sure = best("aim=0.05,speed=1%,tip=0"), errs = best("aim=0.8,speed=1%,tip=0"),
               slips = best("aim=0.05,speed=40%,tip=0");
    EXPECT_GT(sure.at("makes").at("value"), errs.at("makes").at("value"));
    EXPECT_GT(sure.at("worth"), errs.at("worth"));
    EXPECT_GT(sure.at("worth"), slips.at("worth"));
    EXPECT_EQ(carom({"advise", far, "--hand", "grip=1"}).status, 2);
}

TEST_F(CliGames, AFoulGivesTheCueBallInHand) {
    // The cue ball hits no ball.
    const std::string miss = folder_.write("miss.toml",
                                           "[table]\npreset = \"nine_foot\"\n"
                                           "[[ball]]\nid = \"cue\"\nposition = [0.3, 0.4]\n"
                                           "[[ball]]\nid = \"1\"\nposition = [1.0, 2.0]\n"
                                           "[[ball]]\nid = \"9\"\nposition = [0.4, 2.0]\n"
                                           "[cue]\nspeed = 0.5\naim_deg = 0\noffset = [0, 0]\n");
    std::ofstream(file("state.json")) << R"({"game": "nine_ball", "opening": false})";
    const ProcessResult judged = carom({"judge", miss, "--state", file("state.json")});
    ASSERT_EQ(judged.status, 0) << judged.err;
    EXPECT_TRUE(contains(judged.out, "foul: no ball hit (WPA")) << judged.out;
    EXPECT_TRUE(contains(judged.out, "player 2 shoots, cue ball in hand anywhere")) << judged.out;
    const Json json = Json::parse(carom({"judge", miss, "--state", file("state.json"), "--json"}).out);
    EXPECT_EQ(json.at("fouls").at(0).at("foul"), "no ball hit");
    EXPECT_EQ(json.at("options").at(0).at("state").at("in_hand"), "anywhere");

    ASSERT_EQ(carom({"next", miss, "--state", file("state.json"), "-o", file("n.toml"), "--place", "0.5,0.7"})
                  .status,
              0);
    const Scene next = read_scene(file("n.toml"));
    EXPECT_EQ(next.ball[0].position.x(), 0.5);
    EXPECT_EQ(next.ball[0].position.y(), 0.7);
}

TEST_F(CliGames, RuleOptionsAreKeptInTheState) {
    const std::string open = CAROM_SOURCE_DIR "/scenes/eight_ball_break.toml";
    const ProcessResult judged = carom({"judge", open, "--game", "eight_ball", "--rules", "call=none",
                                        "--rules", "in_hand=behind_line", "--state-out", file("state.json")});
    ASSERT_EQ(judged.status, 0) << judged.err;
    const Json state = Json::parse(read_file(file("state.json")));
    EXPECT_EQ(state.at("rules"), Json({"call=none", "in_hand=behind_line"}));
    const ProcessResult none = carom({"judge", open, "--game", "eight_ball", "--rules", "push_out=true"});
    EXPECT_EQ(none.status, 2);
    EXPECT_EQ(none.err,
              "carom: --rules eight_ball has no option \"push_out\"; it has call, eight_on_break, in_hand, "
              "jump\n");
    const ProcessResult value = carom({"judge", open, "--game", "eight_ball", "--rules", "call=some"});
    EXPECT_EQ(value.status, 2);
    EXPECT_EQ(value.err, "carom: --rules call=some: expected call=all|eight|none\n");
    std::ofstream(file("bad.json")) << R"({"game": "snooker", "rules": ["call=all"]})";
    const ProcessResult bad = carom({"judge", open, "--state", file("bad.json")});
    EXPECT_EQ(bad.status, 2);
    EXPECT_TRUE(contains(bad.err, "bad.json: rules: snooker has no option \"call\"; it has miss")) << bad.err;
    const ProcessResult listed = carom({"describe", "games"});
    EXPECT_TRUE(contains(listed.out, "  nine_on_break = wins | respot\n")) << listed.out;
}

TEST_F(CliGames, FourteenBallsAreRackedAroundTheBreakBall) {
    const std::string pot = folder_.write("pot.toml",
                                          "[table]\npreset = \"nine_foot\"\n"
                                          "[[ball]]\nid = \"cue\"\nposition = [0.3, 0.3]\n"
                                          "[[ball]]\nid = \"7\"\nposition = [0.2, 0.2]\n"
                                          "[[ball]]\nid = \"9\"\nposition = [0.9, 1.6]\n"
                                          "[cue]\nspeed = 1.5\naim_deg = 225\noffset = [0, -0.2]\n");
    std::ofstream(file("state.json")) << R"({"game": "straight_pool", "opening": false, "in_hand": "no"})";
    const std::vector<std::string> called = {"--state", file("state.json"), "--ball", "7", "--pocket", "p1"};
    std::vector<std::string> judge = {"judge", pot}, next = {"next", pot, "-o", file("n.toml")};
    judge.insert(judge.end(), called.begin(), called.end());
    next.insert(next.end(), called.begin(), called.end());
    const ProcessResult judged = carom(judge);
    EXPECT_TRUE(contains(judged.out, "fair\n1 point scored\nplayer 1 shoots\n1 is respotted at "))
        << judged.out;
    EXPECT_EQ(lines_of(judged.out).size(), 17u) << judged.out;
    ASSERT_EQ(carom(next).status, 0);
    const Scene racked = read_scene(file("n.toml"));
    ASSERT_EQ(racked.ball.size(), 16u);
    EXPECT_EQ(planar(racked.ball[index_of(racked.ball, "9")].position), Vec2(0.9, 1.6));
    EXPECT_EQ(carom({"check", file("n.toml")}).status, 0);
}

TEST_F(CliGames, ACallThatTheTableOrTheGameDoesNotHaveIsRefused) {
    const auto message = [&](const std::vector<std::string>& call, const std::string& state) {
        std::vector<std::string> words = {"judge", CAROM_SOURCE_DIR "/scenes/eight_ball_break.toml",
                                          "--state", folder_.write("s.json", state)};
        words.insert(words.end(), call.begin(), call.end());
        const ProcessResult result = carom(words);
        EXPECT_EQ(result.status, 2) << result.out;
        return result.err;
    };
    const std::string eight = R"({"game": "eight_ball", "opening": false})";
    EXPECT_TRUE(contains(message({"--ball", "99"}, eight), "the table has no ball \"99\"; it has cue, "));
    EXPECT_TRUE(
        contains(message({"--pocket", "zzz"}, eight), "no pocket \"zzz\"; it has p1, p2, p3, p4, p5, p6"));
    EXPECT_TRUE(contains(message({"--push-out"}, eight), "eight_ball has no push out; leave it out"));
    EXPECT_TRUE(
        contains(message({"--safety"}, R"({"game": "nine_ball"})"), "nine_ball has no called safety"));
    EXPECT_TRUE(contains(message({}, R"({"game": "eight_ball", "group": ["solids", "solids"]})"),
                         "the groups are solids and solids"));
    EXPECT_TRUE(contains(message({}, R"({"game": "eight_ball", "group": ["solids", "open"]})"),
                         "the groups are solids and open"));
}

TEST_F(CliGames, AnAdviceNeedsNoStateFile) {
    const std::string scene = folder_.write("open.toml",
                                            "[table]\npreset = \"nine_foot\"\n"
                                            "[[ball]]\nid = \"cue\"\nposition = [0.3, 0.4]\n"
                                            "[[ball]]\nid = \"3\"\nposition = [0.3, 1.2]\n"
                                            "[[ball]]\nid = \"9\"\nposition = [0.8, 1.6]\n"
                                            "[[ball]]\nid = \"8\"\nposition = [0.2, 2.3]\n");
    const auto asked = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"advise", scene, "--best", "1", "--json"});
        return carom(more);
    };
    const ProcessResult stripes = asked({"--group", "stripes", "--in-hand", "line"});
    ASSERT_EQ(stripes.status, 0) << stripes.err;
    const Json best = Json::parse(stripes.out).at(0);
    EXPECT_EQ(best.at("call").at("ball"), "9");
    EXPECT_LT(best.at("place").at(1), 0.635);
    EXPECT_EQ(asked({"--game", "nine_ball", "--on", "3"}).status, 0);
    EXPECT_TRUE(
        contains(asked({"--game", "nine_ball", "--on", "9"}).err, "the rules let the cue ball hit 3 first"));
    EXPECT_TRUE(contains(asked({"--game", "nine_ball", "--group", "solids"}).err, "nine_ball has no groups"));
    EXPECT_TRUE(contains(asked({"--game", "snooker"}).err, "carom does not play snooker"));
    EXPECT_EQ(asked({"--hand", "aim=0.2,cloth=9%,places=1"}).status, 0);
}

TEST_F(CliGames, AMissMayBeReplayed) {
    const std::string miss = folder_.write("miss.toml",
                                           "[table]\npreset = \"snooker\"\n[balls]\npreset = \"snooker\"\n"
                                           "[[ball]]\nid = \"cue\"\nposition = [0.3, 0.4]\n"
                                           "[[ball]]\nid = \"1\"\nposition = [1.0, 2.0]\n"
                                           "[[ball]]\nid = \"black\"\nposition = [0.5, 3.0]\n"
                                           "[cue]\nspeed = 0.5\naim_deg = 0\noffset = [0, 0]\n");
    std::ofstream(file("state.json")) << R"({"game": "snooker", "opening": false, "in_hand": "no"})";
    const ProcessResult judged =
        carom({"judge", miss, "--state", file("state.json"), "--rules", "miss=true"});
    EXPECT_TRUE(contains(judged.out, "play on: player 2 shoots, red on\n")) << judged.out;
    EXPECT_TRUE(contains(judged.out, "replace the balls: player 1 shoots, red on\n     every ball returns"))
        << judged.out;
    const std::vector<std::string> all = {"next",    miss,           "--state",     file("state.json"),
                                          "--rules", "miss=true",    "--option",    "3",
                                          "-o",      file("n.toml"), "--state-out", file("after.json")};
    const ProcessResult result = carom(all);
    ASSERT_EQ(result.status, 0) << result.err;
    const Scene again = read_scene(file("n.toml"));
    EXPECT_EQ(planar(again.ball[0].position), Vec2(0.3, 0.4));
    const Json after = Json::parse(read_file(file("after.json")));
    EXPECT_EQ(after.at("points"), Json({0, 4}));
    EXPECT_EQ(after.at("fouls"), Json({1, 0}));
    EXPECT_EQ(after.at("turn"), 0);
}

}  // namespace
}  // namespace carom::test
