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
}

}  // namespace
}  // namespace carom::test
