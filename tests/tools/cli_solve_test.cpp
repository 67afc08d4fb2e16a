// carom solve and carom break: what they print, write and refuse.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/scene.h"
#include "carom/engine/simulate.h"
#include "cli.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

class CliSolve : public ::testing::Test {
  protected:
    TemporaryFolder folder_;
    const std::string draw_ = CAROM_SOURCE_DIR "/scenes/draw.toml";
};

TEST_F(CliSolve, FindsAShotAndWritesIt) {
    const std::string file = folder_.file("best.toml");
    const ProcessResult result = carom({"solve", draw_, "--want", "\"1\" in pocketed", "--vary",
                                        "cue.aim_deg=uniform(120,150)", "--shots", "2000", "-o", file});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(contains(result.out, "wanted: \"1\" in pocketed\n1. ")) << result.out;
    EXPECT_TRUE(contains(result.out, "falls 1 into p3")) << result.out;
    EXPECT_NEAR(read_scene(file).cue->aim_deg, 135.0, 2.0);
    EXPECT_TRUE(contains(read_file(file), "# Found by carom for: "));
    const Json json = Json::parse(
        carom({"solve", draw_, "--want", "scratch", "--shots", "2000", "--json", "--hand", "aim=0"}).out);
    EXPECT_EQ(json.at("solutions").at(0).at("values").size(), 3u);
    EXPECT_TRUE(json.at("solutions").at(0).at("success").is_number());
}

TEST_F(CliSolve, MovesABallExactlyToItsPlace) {
    const std::string file = folder_.file("exact.toml");
    const std::vector<std::string> call = {"solve",   draw_,
                                           "--want",  "pocket_of(1) == \"p3\"",
                                           "--want",  "cue near (1.0, 1.56, 0.1)",
                                           "--vary",  "cue.aim_deg=uniform(134,136)",
                                           "--vary",  "cue.speed=uniform(2,3)",
                                           "--shots", "4000",
                                           "--best",  "1",
                                           "--exact"};
    std::vector<std::string> written = call;
    written.insert(written.end(), {"-o", file, "--json"});
    const ProcessResult result = carom(written);
    ASSERT_EQ(result.status, 0) << result.err;
    const Json exact = Json::parse(result.out).at("exact").at(0);
    EXPECT_EQ(exact.at("trouble"), "");
    EXPECT_LE(exact.at("miss_m").get<double>(), 1e-6);
    const Scene scene = read_scene(file);
    const Record record = simulate(make_plan(scene, kernel::Isa::kScalar));
    EXPECT_LT((planar(record.state_at(0, record.duration).position) - Vec2(1.0, 1.56)).norm(), 1e-5);
    EXPECT_TRUE(contains(carom(call).out, "   exactly there, within "));
    const ProcessResult nowhere = carom({"solve", draw_, "--want", "scratch", "--exact"});
    EXPECT_EQ(nowhere.status, 2);
    EXPECT_TRUE(contains(nowhere.err, "--exact: no place is wanted; add one")) << nowhere.err;
}

TEST_F(CliSolve, DrawsTheShotBesideItsMap) {
    const std::string file = folder_.file("map.svg");
    const std::vector<std::string> call = {
        "solve", draw_,    "--want", "\"1\" in pocketed", "--vary", "cue.aim_deg=uniform(120,150)", "--shots",
        "1000",  "--plot", file};
    const ProcessResult one = carom(call);
    EXPECT_EQ(one.status, 2);
    EXPECT_TRUE(contains(one.err, "--plot: a map needs two inputs to choose; give two --vary")) << one.err;
    std::vector<std::string> two = call;
    two.insert(two.end(), {"--vary", "cue.speed=uniform(1,4)"});
    const ProcessResult result = carom(two);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(read_file(file).substr(0, 5), "<?xml");
    two[9] = folder_.file("map.gif");
    EXPECT_TRUE(contains(carom(two).err, "expected a name that ends with .svg, .pdf or .png"));
}

TEST_F(CliSolve, RecommendsABreak) {
    const std::string scene = folder_.file("b.toml"), page = folder_.file("b.html");
    for (const char* game : {"nine_ball", "ten_ball"}) {
        const ProcessResult result =
            carom({"break", game, "--shots", "1000", "-o", scene, "--page", page, "--units", "inch"});
        ASSERT_EQ(result.status, 0) << result.err;
        EXPECT_TRUE(contains(result.out, "diamonds from the left rail")) << result.out;
        EXPECT_TRUE(contains(result.out, " mph)")) << result.out;
        EXPECT_EQ(carom({"check", scene}).status, 0);
        EXPECT_TRUE(contains(read_file(page), "<html"));
    }
}

TEST_F(CliSolve, MistakesSayWhatIsExpected) {
    const auto refused = [&](std::vector<std::string> more, const std::string& why) {
        more.insert(more.begin(), {"solve", draw_});
        const ProcessResult result = carom(more);
        EXPECT_EQ(result.status, 2);
        EXPECT_TRUE(contains(result.err, why)) << result.err;
    };
    refused({"--want", "potted"}, "--want \"potted\"");
    refused({"--want", "scratch", "--vary", "cue.speed=normal(1)"}, "expected KEY=uniform(a,b)");
    refused({"--want", "scratch", "--vary", "cue.speed=uniform(2,1)"}, "with a <= b");
    refused({"--want", "scratch", "--vary", "cue.speed=uniform(nan,1)"}, "");
    refused({"--want", "scratch", "--vary", "cue.sped=uniform(1,2)"}, "cue.sped");
    refused({"--want", "scratch", "--vary", "hit.9=uniform(0,1)"}, "has no ball \"9\"");
    refused({"--want", "scratch", "--hand", "aim=-1"}, "--hand aim=-1: expected aim=DEGREES");
    refused({"--want", "scratch", "--hand", "speed=3"}, "--hand speed=3: expected");
    refused({"--want", "scratch", "--hand", "luck=1"}, "there is no \"luck\"");
    refused({"--want", "scratch", "--shots", "10"}, "--shots: Value 10 not in range");
    refused({"--want", "foul"}, "expected foul(GAME)");
    EXPECT_EQ(carom({"break", "chess"}).status, 2);
    EXPECT_EQ(carom({"break", "--rack", "gap=1"}).status, 2);
    EXPECT_EQ(carom({"break", "--speed-max", "0"}).status, 2);
    EXPECT_EQ(carom({"break", "--radius-sd", "1"}).status, 2);
    EXPECT_TRUE(contains(carom({"break", "--rack", "wood"}).err,
                         "the rack \"wood\" is not known; use template, triangle or gap=METRES"));
    EXPECT_EQ(carom({"break", "--table", "snook"}).status, 2);
}

TEST_F(CliSolve, ASweepMeasuresAndSumsUp) {
    const std::string table = folder_.file("m.csv");
    const std::vector<std::string> sweep = {
        "sweep",     draw_,      "--vary",    "cue.aim_deg=normal(0.5)", "--count",   "200",
        "-o",        table,      "--measure", "\"1\" in pocketed",       "--measure", "travel(cue)",
        "--measure", "first_hit"};
    const ProcessResult told = carom(sweep);
    ASSERT_EQ(told.status, 0) << told.err;
    EXPECT_TRUE(contains(told.out, "\"1\" in pocketed\n  true ")) << told.out;
    EXPECT_TRUE(contains(told.out, "travel(cue)\n  mean ")) << told.out;
    EXPECT_TRUE(contains(told.out, "first_hit\n  1  ")) << told.out;
    const std::string header = read_file(table).substr(0, read_file(table).find('\n'));
    EXPECT_TRUE(header.ends_with(",message,\"\"\"1\"\" in pocketed\",travel(cue),first_hit")) << header;
    std::vector<std::string> as_json = sweep;
    as_json[7] = folder_.file("j.csv");
    as_json.push_back("--json");
    const Json json = Json::parse(carom(as_json).out);
    EXPECT_EQ(json.at("measures").size(), 3u);
    EXPECT_EQ(json.at("measures").at(0).at("shots"), 200);
    // Rules cannot judge these shots, and a mistake is told.
    as_json[7] = folder_.file("f.csv");
    as_json.insert(as_json.end(), {"--measure", "foul(nine_ball)"});
    const ProcessResult refused = carom(as_json);
    EXPECT_EQ(refused.status, 2);
    EXPECT_TRUE(contains(refused.err, "--measure foul(nine_ball): ")) << refused.err;
}

}  // namespace
}  // namespace carom::test
