// Snooker's touching ball, jump shot and snooker behind the free ball, judged by carom judge.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli.h"

namespace carom::test {
namespace {

class CliSnooker : public ::testing::Test {
  protected:
    /// A verdict. `balls`: "id x y" lines; `cue`: the keys of [cue].
    std::string judged(const std::string& balls, const std::string& cue, const std::string& state,
                       const std::string& nominated = "") const {
        std::string scene = "[table]\npreset = \"snooker\"\n[balls]\npreset = \"snooker\"\n";
        for (const std::string& line : lines_of(balls)) {
            const std::size_t space = line.find(' ');
            std::string place = line.substr(space + 1);
            place.replace(place.find(' '), 1, ", ");
            scene += "[[ball]]\nid = \"" + line.substr(0, space) + "\"\nposition = [" + place + "]\n";
        }
        const std::string file = folder_.write("s.toml", scene + "[cue]\noffset = [0, 0]\n" + cue);
        const std::string before = folder_.write(
            "s.json", R"({"game": "snooker", "turn": 0, "opening": false, "in_hand": "no", )" + state + "}");
        std::vector<std::string> arguments = {"judge", file, "--state", before};
        if (!nominated.empty()) arguments.insert(arguments.end(), {"--ball", nominated});
        const ProcessResult result = carom(arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        return result.out;
    }
    TemporaryFolder folder_;
};

constexpr char kRed[] = R"("points": [0, 0], "on": "red")";

TEST_F(CliSnooker, ATouchingBallThatIsOnCountsAsHit) {
    const std::string cue = "cue 0.8475 2.2\n", away = "speed = 0.5\naim_deg = 120\n",
                      far = "black 0.889 3.245\n";
    const std::string red = judged(cue + "1 0.9 2.2\n2 0.5 3.4\n" + far, away, kRed);
    EXPECT_EQ(red.substr(0, 4), "fair") << red;
    EXPECT_FALSE(contains(red, "points")) << red;
    const std::string blue = judged(cue + "blue 0.9 2.2\n" + far, away, R"("points": [0, 0], "on": "blue")");
    EXPECT_EQ(blue.substr(0, 4), "fair") << blue;
    const std::string black = judged(cue + "black 0.9 2.2\n", away, R"("points": [50, 52], "on": "black")");
    EXPECT_EQ(black.substr(0, 4), "fair") << black;
    EXPECT_FALSE(contains(black, "wins")) << black;
    const std::string colour =
        judged(cue + "pink 0.9 2.2\n1 0.5 3.4\n" + far, away, R"("points": [1, 0], "on": "colour")", "pink");
    EXPECT_EQ(colour.substr(0, 4), "fair") << colour;
    // A ball that is not on does not count, nor does one that is merely near.
    EXPECT_TRUE(contains(judged(cue + "pink 0.9 2.2\n2 0.5 3.4\n" + far, away, kRed), "no ball hit"));
    EXPECT_TRUE(contains(judged(cue + "1 0.901 2.2\n2 0.5 3.4\n" + far, away, kRed), "no ball hit"));
}

TEST_F(CliSnooker, AJumpOverABallBeforeOneIsHitIsAFoul) {
    const std::string jump = "speed = 4.6\naim_deg = 90\nelevation_deg = 35\nmass = 0.25\n";
    const std::string over =
        judged("cue 0.889 0.6\nbrown 0.889 0.96\n1 0.889 1.9\nblack 0.889 3.245\n", jump, kRed);
    EXPECT_TRUE(contains(over, "foul: jump shot")) << over;
    EXPECT_TRUE(contains(over, "4 points for the other player")) << over;
    // Over the ball on itself.
    const std::string own =
        judged("cue 0.889 0.6\n1 0.889 0.96\n2 0.889 1.9\nblack 0.889 3.245\n", jump, kRed);
    EXPECT_TRUE(contains(own, "foul: jump shot")) << own;
    // With blue on, the penalty is 5.
    const std::string blue = judged("cue 0.889 0.6\npink 0.889 0.96\nblue 0.889 1.9\nblack 0.889 3.245\n",
                                    jump, R"("points": [0, 0], "on": "blue")");
    EXPECT_TRUE(contains(blue, "5 points for the other player")) << blue;
    // A touching ball that is on counts as hit, and the jump is still a jump over others.
    const std::string touching =
        judged("cue 0.889 1.2\n1 0.889 1.1475\npink 0.86225 1.5\nblack 0.91575 1.5\n2 0.889 2.9\n",
               "speed = 3.5\naim_deg = 90\nelevation_deg = 30\n", kRed);
    EXPECT_TRUE(contains(touching, "foul: jump shot")) << touching;
    // A jump past a ball, or after a hit, is fair.
    const std::string beside =
        judged("cue 0.889 0.6\nbrown 0.8 0.96\n1 0.889 1.9\nblack 0.889 3.245\n", jump, kRed);
    EXPECT_EQ(beside.substr(0, 4), "fair") << beside;
}

TEST_F(CliSnooker, TheFreeBallMustNotSnooker) {
    const std::string stroke = "speed = 0.25\naim_deg = 90\n",
                      free = R"("points": [0, 4], "on": "red", "free_ball": true)";
    const std::string behind =
        judged("cue 0.5 1.0\nyellow 0.5 1.1\n1 0.5 2.5\nblack 0.889 3.245\n", stroke, free, "yellow");
    EXPECT_TRUE(contains(behind, "foul: snooker behind the free ball")) << behind;
    EXPECT_TRUE(contains(behind, "4 points for the other player")) << behind;
    const std::string colours = judged("cue 0.5 1.0\nblack 0.5 1.1\nblue 0.5 2.5\npink 0.889 3.0\n", stroke,
                                       R"("points": [0, 4], "on": "blue", "free_ball": true)", "black");
    EXPECT_TRUE(contains(colours, "5 points for the other player")) << colours;
    // Not if a red is free, not behind another ball, and not with only pink and black left.
    EXPECT_EQ(judged("cue 0.5 1.0\nyellow 0.5 1.1\n1 0.5 2.5\n2 1.2 1.2\nblack 0.889 3.245\n", stroke, free,
                     "yellow")
                  .substr(0, 4),
              "fair");
    EXPECT_EQ(judged("cue 0.5 1.0\nblack 0.5 1.1\npink 0.5 2.5\n", stroke,
                     R"("points": [0, 4], "on": "pink", "free_ball": true)", "black")
                  .substr(0, 4),
              "fair");
}

}  // namespace
}  // namespace carom::test
