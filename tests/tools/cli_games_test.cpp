// carom judge and carom next: a match from the shell, and states that are refused.
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
        // The output is a scene that plays.
        ASSERT_EQ(carom({"check", next}).status, 0);
        scene = next;
        state = {"--state", after};
    }
    EXPECT_GE(shots, 3);
}

TEST_F(CliGames, AFoulGivesTheCueBallInHand) {
    // The cue ball hits nothing.
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
    const ProcessResult there =
        carom({"next", miss, "--state", file("state.json"), "-o", file("no.toml"), "--place", "1.0,2.01"});
    EXPECT_EQ(there.status, 2);
    EXPECT_TRUE(contains(there.err, "may not lie there")) << there.err;
    EXPECT_FALSE(std::filesystem::exists(file("no.toml")));
}

TEST_F(CliGames, StatesThatAreNoneAreRefused) {
    const auto refused = [&](const std::string& text, const std::string& why) {
        std::ofstream(file("bad.json")) << text;
        const ProcessResult result = carom({"judge", break_, "--state", file("bad.json")});
        EXPECT_EQ(result.status, 2) << text;
        EXPECT_TRUE(contains(result.err, why)) << result.err;
    };
    refused("", "expected a state of a game");
    refused("[1]", "expected a state of a game");
    refused("{}", "game: expected the name of the game");
    refused(R"({"game": "chess"})", "game: expected one of eight_ball");
    refused(R"({"game": 7})", "game: expected one of eight_ball");
    refused(R"({"game": "nine_ball", "turn": 2})", "turn: expected a whole number from 0 to 1");
    refused(R"({"game": "nine_ball", "turn": 1e300})", "turn: expected a whole number from 0 to 1");
    refused(R"({"game": "nine_ball", "turn": 99999999999999999999})", "turn: expected a whole number");
    refused(R"({"game": "nine_ball", "over": 1})", "over: expected true or false");
    refused(R"({"game": "nine_ball", "points": [1]})", "points: expected one whole number for each player");
    refused(R"({"game": "nine_ball", "fouls": [1, 4000000000]})", "fouls: expected a whole number from 0");
    refused(R"({"game": "nine_ball", "group": ["open", "red"]})", "group: expected one of open");
    refused(R"({"game": "nine_ball", "shots": 3})", "unknown key \"shots\"");
    refused(R"({"game": "nine_ball", "over": true})", "over");
    EXPECT_EQ(carom({"judge", break_, "--state", file("none.json")}).status, 2);
    EXPECT_EQ(carom({"judge", break_}).status, 2);
    EXPECT_EQ(carom({"judge", break_, "--game", "nine_ball", "--option", "5"}).status, 2);
    EXPECT_EQ(carom({"next", break_, "--game", "snooker", "-o", file("n.toml")}).status, 2);
    EXPECT_FALSE(std::filesystem::exists(file("n.toml")));
}

}  // namespace
}  // namespace carom::test
