// carom fit: its results, output and refusals.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "carom/engine/plan.h"
#include "carom/engine/scene.h"
#include "carom/engine/simulate.h"
#include "cli.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

class CliFit : public ::testing::Test {
  protected:
    /// Places of both balls of the draw shot, 50 times a second, bit for bit.
    std::string tracks() {
        const Record record = simulate(make_plan(read_scene(draw_), kernel::Isa::kScalar));
        std::string text = "x, y, ball, t\n";
        for (int k = 0; k < 75; ++k)
            for (int ball = 0; ball < 2; ++ball) {
                const BallState state = record.state_at(ball, k / 50.0);
                if (is_gone(state.state)) continue;
                text += fmt::format("{}, {}, {}, {}\n", state.position.x(), state.position.y(),
                                    record.tracks[static_cast<std::size_t>(ball)].id, k / 50.0);
            }
        return folder_.write("tracks.csv", text + "\n# a gap\n,,cue,1.6\n");
    }
    std::string guess() {
        Scene scene = read_scene(draw_);
        scene.balls.mu_s = 0.204;
        scene.cue->speed = 2.24;
        return folder_.write("guess.toml", scene_text(scene));
    }
    TemporaryFolder folder_;
    const std::string draw_ = CAROM_SOURCE_DIR "/scenes/draw.toml";
};

TEST_F(CliFit, RecoversTheNumbersOfTheTracks) {
    const std::string file = folder_.file("fitted.toml"), rows = folder_.file("residuals.csv");
    const ProcessResult result = carom(
        {"fit", guess(), tracks(), "--vary", "balls.mu_s,cue.speed", "--json", "-o", file, "--csv", rows});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json json = Json::parse(result.out);
    EXPECT_TRUE(json.at("success").get<bool>());
    EXPECT_NEAR(json.at("x").at(0).get<double>(), 0.2, 1e-7);
    EXPECT_NEAR(json.at("x").at(1).get<double>(), 2.25, 1e-7);
    EXPECT_LT(json.at("rms").get<double>(), 1e-8);
    EXPECT_EQ(json.at("cov").size(), 2u);
    EXPECT_NEAR(read_scene(file).balls.mu_s, 0.2, 1e-7);
    EXPECT_TRUE(contains(read_file(rows), "t,ball,x,y,dx,dy\n0,cue,0.6,1.94,"));
}

TEST_F(CliFit, ReadsTheSamplesOfAShot) {
    const std::string samples = folder_.file("samples.csv");
    ASSERT_EQ(carom({"simulate", draw_, "--samples", samples, "--sample-dt", "0.02"}).status, 0);
    const ProcessResult result = carom({"fit", guess(), samples, "--vary", "cue.speed,balls.mu_s"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(contains(result.out, "cue.speed                             2.25")) << result.out;
}

TEST_F(CliFit, ReadsSemicolonsTabsAndCapitalNames) {
    for (const char separator : {';', '\t'}) {
        std::string text = tracks();
        text = read_file(text);
        std::replace(text.begin(), text.end(), ',', separator);
        text.replace(0, text.find('\n'), fmt::format("X{0}Y{0}Ball{0}Time", separator));
        const std::string file = folder_.write("other.csv", text);
        const ProcessResult result = carom({"fit", guess(), file, "--vary", "cue.speed,balls.mu_s"});
        EXPECT_EQ(result.status, 0) << result.err;
    }
    const std::string spaces = folder_.write("spaces.csv", "t ball x y\n0 cue 0.6 1.94\n");
    const ProcessResult result = carom({"fit", guess(), spaces, "--vary", "cue.speed"});
    EXPECT_EQ(result.status, 2);
    EXPECT_TRUE(contains(result.err,
                         "spaces.csv:1:1: there is no column t in \"t ball x y\"; name the columns "
                         "t,ball,x,y in the first line, and separate them by commas"))
        << result.err;
    const std::string comma = folder_.write("comma.csv", "t;ball;x;y\n0,1;cue;0,6;1,94\n");
    EXPECT_TRUE(contains(carom({"fit", guess(), comma, "--vary", "cue.speed"}).err, "with a decimal point"));
}

// Every mistake leaves more than a ball's radius, and is named.
TEST_F(CliFit, AMistakeInTheTracksIsNoFitAndIsNamed) {
    const Record record = simulate(make_plan(read_scene(draw_), kernel::Isa::kScalar));
    const auto message = [&](double per_second, auto place) {
        std::string text = "t,ball,x,y\n";
        for (int k = 0; k < 75; ++k) {
            const BallState state = record.state_at(0, k / 50.0);
            const Vec2 at = place(planar(state.position));
            text += fmt::format("{},cue,{},{}\n", k / 50.0 * per_second, at.x(), at.y());
        }
        const std::string file = folder_.write("wrong.csv", text);
        const ProcessResult result = carom({"fit", guess(), file, "--vary", "balls.mu_s,cue.speed"});
        EXPECT_EQ(result.status, 1) << result.out;
        return result.err;
    };
    const auto same = [](const Vec2& at) { return at; };
    EXPECT_TRUE(contains(message(1000.0, same), "the times look like milliseconds"));
    EXPECT_TRUE(contains(message(50.0, same), "the times look like frames at 50 a second"));
    EXPECT_TRUE(contains(message(30.0, same), "the times look like frames at 30 a second"));
    EXPECT_TRUE(
        contains(message(1.0, [](const Vec2& at) { return Vec2(at.y(), at.x()); }), "x and y look swapped"));
    EXPECT_TRUE(
        contains(message(1.0, [&](const Vec2& at) { return Vec2(record.table.width - at.x(), at.y()); }),
                 "x looks measured from the right"));
    EXPECT_TRUE(contains(message(1.0, [](const Vec2& at) { return Vec2(at.x() * 0.8, at.y() * 0.8 + 0.2); }),
                         "check that they are of this shot"));
}

TEST_F(CliFit, WarnsAboutUndeterminedNumbers) {
    const ProcessResult result =
        carom({"fit", guess(), tracks(), "--vary", "balls.mu_s", "--vary", "balls.e_c"});
    EXPECT_TRUE(contains(result.err, "balls.e_c has no effect on the tracked positions")) << result.err;
}

}  // namespace
}  // namespace carom::test
