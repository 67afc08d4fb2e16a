// carom solve and carom break: their output, files and refusals.
#include <gtest/gtest.h>

#include <algorithm>
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
    EXPECT_TRUE(
        contains(result.out,
                 "wanted: \"1\" in pocketed\nunknown: cloth=5%,rails=2%,places=0.1,gaps=20; each shot "
                 "draws it (standard deviations)\nsearches from 2 places, on their own so far: "))
        << result.out;
    EXPECT_TRUE(contains(result.out, "\n1. ")) << result.out;
    EXPECT_TRUE(contains(result.out, " of 100 shots; exact table: ")) << result.out;
    EXPECT_TRUE(contains(result.out, "falls 1 into p3")) << result.out;
    EXPECT_NEAR(read_scene(file).cue->aim_deg, 135.0, 2.0);
    EXPECT_TRUE(contains(read_file(file), "# Found by carom for: "));
    const Json json = Json::parse(
        carom({"solve", draw_, "--want", "scratch", "--shots", "2000", "--json", "--hand", "aim=0"}).out);
    EXPECT_EQ(json.at("solutions").at(0).at("values").size(), 3u);
    EXPECT_TRUE(json.at("solutions").at(0).at("success").is_number());
    EXPECT_TRUE(json.at("solutions").at(0).at("exact_success").is_number());
    EXPECT_EQ(json.at("searches").size(), 2u);
    const std::string exact =
        carom({"solve", draw_, "--want", "scratch", "--shots", "2000", "--unknown", "none"}).out;
    EXPECT_TRUE(contains(exact, "unknown: nothing, exact tables\n")) << exact;
    EXPECT_FALSE(contains(exact, "; exact table: ")) << exact;
}

TEST_F(CliSolve, MovesABallExactlyToItsPlace) {
    const std::string file = folder_.file("exact.toml");
    std::vector<std::string> call = {"solve",   draw_,
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
    EXPECT_LE(exact.at("miss").get<double>(), 1e-6);
    const Scene scene = read_scene(file);
    const Record record = simulate(make_plan(scene, kernel::Isa::kScalar));
    EXPECT_LT((planar(record.state_at(0, record.duration).position) - Vec2(1.0, 1.56)).norm(), 1e-5);
    EXPECT_TRUE(contains(carom(call).out, "   exactly there, within "));
    // If shots of different kinds lead to one exact shot, it is printed once.
    call[call.size() - 2] = "3";
    *std::find(call.begin(), call.end(), "cue.speed=uniform(2,3)") = "cue.speed=uniform(2.42,2.5)";
    const auto count = [&](const std::string& text) {
        std::size_t found = 0;
        for (const std::string& line : lines_of(carom(call).out)) found += contains(line, text) ? 1 : 0;
        return found;
    };
    EXPECT_EQ(count("exactly there, within "), 1u);
    EXPECT_EQ(count("exactly there: as in 1."), 2u);
}

TEST_F(CliSolve, DrawsTheShotBesideItsMap) {
    const std::string file = folder_.file("map.svg");
    const ProcessResult result =
        carom({"solve", draw_, "--want", "\"1\" in pocketed", "--vary", "cue.aim_deg=uniform(120,150)",
               "--vary", "cue.speed=uniform(1,4)", "--shots", "1000", "--plot", file});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(read_file(file).substr(0, 5), "<?xml");
}

TEST_F(CliSolve, RecommendsABreak) {
    const std::string scene = folder_.file("b.toml"), page = folder_.file("b.html");
    for (const char* game : {"nine_ball", "ten_ball"}) {
        const ProcessResult result =
            carom({"break", game, "--shots", "1000", "-o", scene, "--page", page, "--units", "inch"});
        ASSERT_EQ(result.status, 0) << result.err;
        EXPECT_TRUE(contains(result.out, "any_pocketed and legal_break")) << result.out;
        EXPECT_TRUE(contains(result.out, "diamonds from the left rail")) << result.out;
        EXPECT_TRUE(contains(result.out, " mph)")) << result.out;
        EXPECT_EQ(carom({"check", scene}).status, 0);
        EXPECT_TRUE(contains(read_file(page), "<html"));
    }
}

TEST_F(CliSolve, ASweepMeasuresAndSummarises) {
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
}

}  // namespace
}  // namespace carom::test
