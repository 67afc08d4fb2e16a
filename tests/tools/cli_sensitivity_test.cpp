// carom sensitivity: its output and refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "cli.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

const std::string kDraw = CAROM_SOURCE_DIR "/scenes/draw.toml";

// The shot lies on a diagonal of the table and of the pocket, so it is symmetric about that line.
TEST(CliSensitivity, OfADiagonalShot) {
    const ProcessResult result = carom({"sensitivity", kDraw, "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json all = Json::parse(result.out), &aim = all.at("inputs").at(0), &cue = all.at("balls").at(0),
               &ball = all.at("balls").at(1);
    EXPECT_EQ(aim.at("input"), "cue.aim_deg");
    EXPECT_NEAR(aim.at("down").get<double>(), aim.at("up").get<double>(), 1e-6);
    const Json &by_aim = cue.at("derivatives").at(0), &by_speed = cue.at("derivatives").at(1);
    EXPECT_NEAR(by_aim.at(0).get<double>(), by_aim.at(1).get<double>(), 1e-9);
    EXPECT_NEAR(by_speed.at(0).get<double>(), -by_speed.at(1).get<double>(), 1e-9);
    EXPECT_TRUE(ball.at("falls").get<bool>());
    const Json& window = ball.at("aim_window_deg");
    EXPECT_NEAR(window.at(0).get<double>(), -window.at(1).get<double>(), 1e-4);
    EXPECT_GT(window.at(1).get<double>(), 0.5);
    // Speed and tip height move the cue ball along the diagonal, aim and side across it.
    const double R = 0.028575, speed = 0.03 * 2.25;
    const auto along = [&](std::size_t k) {
        return std::sqrt(2.0) * std::abs(cue.at("derivatives").at(k).at(0).get<double>());
    };
    EXPECT_NEAR(cue.at("ellipse").at("along_m").get<double>(), std::hypot(speed * along(1), 0.02 * along(3)),
                1e-9);
    EXPECT_NEAR(cue.at("ellipse").at("across_m").get<double>(), std::hypot(0.2 * along(0), 0.02 * along(2)),
                1e-9);
    EXPECT_NEAR(all.at("inputs").at(2).at("nudge").get<double>(), 1e-3 / R, 1e-12);
    EXPECT_NEAR(cue.at("played").at("along_m").get<double>(), cue.at("ellipse").at("along_m").get<double>(),
                0.01);
}

TEST(CliSensitivity, SummarisesForAPlayer) {
    const ProcessResult result = carom({"sensitivity", kDraw, "--shots", "50"});
    ASSERT_EQ(result.status, 0) << result.err;
    for (const char* words : {"aim 0.1 degrees to the left", "1 at its pocket, mm", "1 falls into p3",
                              "The events change first if", "the longer at 135 degrees to first order"})
        EXPECT_TRUE(contains(result.out, words)) << words << "\n" << result.out;
}

// A dot for each shot whose ball stays, and two ellipses for each ball.
TEST(CliSensitivity, DrawsWhereTheBallsEnd) {
    TemporaryFolder folder;
    const std::string file = folder.file("errors.svg");
    const ProcessResult result = carom({"sensitivity", kDraw, "--shots", "60", "--json", "--plot", file});
    if (contains(result.err, "no diagrams")) GTEST_SKIP() << "this build has no cairo";
    ASSERT_EQ(result.status, 0) << result.err;
    const std::string svg = read_file(file);
    EXPECT_TRUE(svg.starts_with("<?xml")) << svg.substr(0, 80);
    // Depending on its version, cairo writes an attribute or a style.
    std::size_t dots = 0;
    for (const std::string dot : {"fill-opacity=\"0.5\"", "fill-opacity:0.5;"})
        for (std::size_t at = svg.find(dot); at != svg.npos; at = svg.find(dot, at + 1)) ++dots;
    const Json ball = Json::parse(result.out).at("balls").at(1);
    EXPECT_EQ(dots, 60u + 60u - ball.at("fell").get<std::size_t>());
}

TEST(CliSensitivity, ABreakHasDerivatives) {
    for (const char* scene : {"nine_ball_break", "snooker_break"}) {
        const ProcessResult result =
            carom({"sensitivity", CAROM_SOURCE_DIR "/scenes/" + std::string(scene) + ".toml", "--shots", "1",
                   "--json"});
        ASSERT_EQ(result.status, 0) << result.err;
        const Json report = Json::parse(result.out);
        for (const Json& input : report.at("inputs"))
            EXPECT_LT(input.at("error").get<double>(), 1e-3) << scene << input;
    }
}

}  // namespace
}  // namespace carom::test
