// Wrong answers that outside users found: refusals, figures that disagree, clocks.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/output_file.h"
#include "cli.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

class CliAnswers : public ::testing::Test {
  protected:
    std::string draw() const { return CAROM_SOURCE_DIR "/scenes/draw.toml"; }
    std::string three_cushion() const { return CAROM_SOURCE_DIR "/scenes/three_cushion.toml"; }
    /// Expects exit status 2 and a message that contains `why`.
    void refused(const std::vector<std::string>& arguments, const std::string& why) const {
        const ProcessResult result = carom(arguments);
        EXPECT_EQ(result.status, 2) << why << "\n" << result.out;
        EXPECT_TRUE(contains(result.err, why)) << result.err;
    }
    /// The samples of a scene as tracks, each line changed by awk.
    std::string tracks(const std::string& scene, const std::string& change) const {
        const std::string plain = folder_.file("plain.csv"), out = folder_.file("tracks.csv");
        EXPECT_EQ(carom({"simulate", scene, "--samples", plain, "--sample-dt", "0.02"}).status, 0);
        const ProcessResult result =
            run_process({"/bin/sh", "-c",
                         "awk -F, -v OFS=, 'NR > 1 { " + change + " } { print }' " + plain + " > " + out},
                        {});
        EXPECT_EQ(result.status, 0) << result.err;
        return out;
    }
    TemporaryFolder folder_;
};

TEST_F(CliAnswers, AnImpossibleGoalIsRefused) {
    const auto want = [this](const std::string& text, const std::string& why) {
        refused({"solve", draw(), "--want", text, "--shots", "1000"}, why);
    };
    want(R"("99" in pocketed)", R"(the scene has no ball "99")");
    want(R"("p1" in pocketed)", R"(the scene has no ball "p1")");
    want(R"(first_hit == "2")", R"(the scene has no ball "2")");
    want(R"(pocket_of(1) == "p99")", R"(the scene has no pocket "p99")");
    want(R"("1" in pockets)", R"(the scene has no pocket "1")");
    want(R"("c99" in cushions)", R"(the scene has no cushion or jaw "c99")");
    want("cue near (0.6, 1.2, -0.05)", "expected METRES of at least 0");
    refused({"solve", draw(), "--want", "scratch", "--vary", "hit.cue=uniform(-1,1)", "--shots", "1000"},
            "hit.cue: the cue strikes this ball");
    refused({"sweep", draw(), "--vary", "cue.speed=uniform(1,2)", "--count", "2", "--measure",
             R"("9" in pocketed)", "-o", folder_.file("a.csv")},
            R"(the scene has no ball "9")");
    // An expression that a shot can meet is accepted.
    for (const char* fine : {R"(pocketed == "1")", R"(pocketed == "1;cue")", R"(pocket_of(1) == "out")",
                             R"(pocket_of(1) != "")", "cue near (1, 1, 0)"})
        EXPECT_EQ(carom({"sweep", draw(), "--vary", "cue.speed=uniform(1,2)", "--count", "1", "--measure",
                         fine, "-o", folder_.file("b.csv")})
                      .status,
                  0)
            << fine;
}

TEST_F(CliAnswers, ANumberThatWouldReplaceAFitIsRefused) {
    const std::string samples = tracks(three_cushion(), "");
    for (const std::string name : {"e_c", "f_c"}) {
        const std::string key = "balls." + name, why = key + "_fit.0";
        refused({"fit", three_cushion(), samples, "--vary", key}, why);
        refused({"sweep", three_cushion(), "--vary", key + "=uniform(0.8,0.9)", "--count", "1", "-o",
                 folder_.file("a.csv")},
                why);
        refused({"solve", three_cushion(), "--want", "scratch", "--vary", key + "=uniform(0.8,0.9)",
                 "--shots", "1000"},
                why);
    }
    const ProcessResult fitted = carom({"fit", three_cushion(), samples, "--vary", "balls.e_c_fit.0"});
    EXPECT_EQ(fitted.status, 0) << fitted.err;
    const std::string drawn = tracks(draw(), "");
    refused({"fit", draw(), drawn, "--vary", "balls.mu_b"}, "balls.mu_b_fit.0");
    // The key named in the message works, although only the preset has the fit.
    EXPECT_EQ(carom({"sweep", three_cushion(), "--vary", "balls.e_c_fit.0=uniform(0.8,0.9)", "--count", "2",
                     "-o", folder_.file("b.csv")})
                  .status,
              0);
    EXPECT_EQ(carom({"sweep", three_cushion(), "--vary", "balls.mu_b=uniform(0.04,0.06)", "--count", "2",
                     "-o", folder_.file("c.csv")})
                  .status,
              0);
}

TEST_F(CliAnswers, AFitOfInconsistentTracksIsRefusedWithoutDeviations) {
    const auto fit = [this](const std::string& change, const std::string& vary) {
        return carom({"fit", draw(), tracks(draw(), change), "--vary", vary, "--json"});
    };
    for (const std::string keys : {"balls.mu_s", "balls.mu_s,cue.speed"}) {
        const ProcessResult late = fit("$1 += 0.1", keys);
        EXPECT_EQ(late.status, 1) << late.out;
        EXPECT_TRUE(contains(late.err, "clock")) << late.err;
        EXPECT_TRUE(Json::parse(late.out).at("std").at(0).is_null());
    }
    for (const auto& [factor, unit] :
         {std::pair{"1000", "mm"}, std::pair{"39.3701", "inches"}, std::pair{"100", "cm"}}) {
        const ProcessResult result = fit(std::string("$4 *= ") + factor + "; $5 *= " + factor, "balls.mu_s");
        EXPECT_EQ(result.status, 1) << result.out;
        EXPECT_TRUE(contains(result.err, std::string("the positions look like ") + unit)) << result.err;
    }
    // If the clock may vary, the fit recovers the stroke.
    const ProcessResult found = fit("$1 += 0.1", "balls.mu_s,clock");
    ASSERT_EQ(found.status, 0) << found.err;
    EXPECT_NEAR(Json::parse(found.out).at("x").at(0).get<double>(), 0.2, 1e-5);
    EXPECT_NEAR(Json::parse(found.out).at("x").at(1).get<double>(), 0.1, 1e-5);
}

TEST_F(CliAnswers, TracksMayBeginWithAByteOrderMark) {
    const std::string plain = tracks(draw(), "");
    for (const std::string start : {"\xEF\xBB\xBF", "\xEF\xBB\xBF# a comment\n", ""}) {
        const std::string marked = folder_.write("marked.csv", start + read_file(plain));
        EXPECT_EQ(carom({"fit", draw(), marked, "--vary", "balls.mu_s"}).status, 0) << start;
    }
}

TEST_F(CliAnswers, TwoSweepsDoNotWriteOneTable) {
    const std::string table = folder_.file("t.csv");
    std::filesystem::create_directory(table + ".0123456789abcdef.parts");
    const auto sweep = [&](const std::string& seed) {
        return carom({"sweep", draw(), "--vary", "cue.speed=uniform(1,2)", "--count", "3", "--seed", seed,
                      "-o", table});
    };
    {
        const FileLock other(table + ".0123456789abcdef.parts/lock", true);
        for (const char* seed : {"1", "2"}) {
            const ProcessResult result = sweep(seed);
            EXPECT_NE(result.status, 0);
            EXPECT_TRUE(contains(result.err, "another sweep is writing this table")) << result.err;
        }
        EXPECT_FALSE(std::filesystem::exists(table));
    }
    EXPECT_EQ(sweep("1").status, 0);
    EXPECT_EQ(sweep("2").status, 0);
}

TEST_F(CliAnswers, EveryShareStatesItsShotsAndAllAgree) {
    const std::string scene = folder_.write("g.toml", R"([table]
cushion = [{from=[0,0],to=[0.36,0]}, {from=[0.44,0],to=[0.8,0]}, {from=[0.8,0],to=[0.8,1.2]},
  {from=[0.8,1.2],to=[0.44,1.2]}, {from=[0.36,1.2],to=[0,1.2]}, {from=[0,1.2],to=[0,0]}]
pocket = [{center=[0.4,-0.01],radius=0.035}, {center=[0.4,1.21],radius=0.035}]
[balls]
radius = 0.027
mass = 0.14
[[ball]]
id = "r1"
position = [0.4, 0.12]
[cue]
ball = "r1"
speed = 1.5
aim_deg = 45
offset = [0, 0]
)");
    const std::vector<std::string> asked = {"solve",   scene,
                                            "--want",  R"("r1" in pocketed)",
                                            "--vary",  "cue.aim_deg=uniform(40,95)",
                                            "--vary",  "cue.speed=uniform(1,3)",
                                            "--shots", "2000",
                                            "--json"};
    const ProcessResult result = carom(asked);
    ASSERT_EQ(result.status, 0) << result.err;
    const Json found = Json::parse(result.out);
    for (const Json& solution : found.at("solutions")) {
        // All falls of the only ball, from the same shots.
        double fell = 0.0;
        for (const Json& fall : solution.at("falls")) fell += fall.at("share").get<double>();
        EXPECT_NEAR(fell, solution.at("success").get<double>(), 1e-12);
        for (const Json& cost : solution.at("costs")) EXPECT_GE(cost.at("shots").get<int>(), 25);
    }
    std::vector<std::string> told = asked;
    told.pop_back();
    for (const std::string& line : lines_of(carom(told).out))
        if (contains(line, "%") && !contains(line, "unknown:") && !contains(line, "searches from")) {
            EXPECT_TRUE(contains(line, "shots")) << line;
        }
}

TEST_F(CliAnswers, AMoveIntoACushionIsImpossible) {
    const std::string scene = folder_.write("rail.toml", R"([[ball]]
id = "cue"
position = [0.0287, 1.0]
[[ball]]
id = "1"
position = [0.3, 1.0]
[cue]
speed = 2
aim_deg = 0
)");
    const ProcessResult result = carom({"solve", scene, "--want", R"(first_hit == "1")", "--vary",
                                        "ball.cue.position.x=uniform(0.0286,0.0287)", "--vary",
                                        "cue.speed=uniform(1,2)", "--shots", "1000", "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json cost = Json::parse(result.out).at("solutions").at(0).at("costs").at(0);
    EXPECT_EQ(cost.at("input"), "ball.cue.position.x");
    EXPECT_TRUE(cost.at("less").is_null()) << cost;
    EXPECT_GT(cost.at("more").get<double>(), 0.9) << cost;
}

TEST_F(CliAnswers, ATableImpliesItsBalls) {
    const auto balls = [this](const std::string& table, const std::string& rest, const std::string& told) {
        const std::string scene = folder_.write(
            "t.toml", "[table]\npreset = \"" + table + "\"\n" + rest + "[[ball]]\nposition = [0.4, 0.4]\n");
        EXPECT_TRUE(contains(carom({"check", scene}).out, "\n          " + told + ": R ")) << table;
    };
    balls("carom", "", "carom");
    balls("carom_small", "[balls]\nmu_s = 0.2\n", "carom");
    balls("snooker", "", "snooker");
    balls("snooker_ten_foot", "", "snooker");
    balls("pyramid", "", "pyramid");
    balls("english_pool", "", "english_pool");
    balls("nine_foot", "", "pool");
    balls("snooker", "[balls]\npreset = \"pool\"\n", "pool");
}

TEST_F(CliAnswers, TheNoteNamesTheObstacleBehindTheCueBall) {
    // A ball behind the cue ball requires more elevation than the rail behind both.
    for (const char* place : {"0.14, 1.0", "0.13, 1.01", "0.1, 0.99"}) {
        const std::string scene = folder_.write(
            "n.toml", "[[ball]]\nid = \"cue\"\nposition = [0.2, 1.0]\n[[ball]]\nid = \"2\"\nposition = [" +
                          std::string(place) + "]\n[cue]\nspeed = 3\naim_deg = 0\noffset = [0, 0]\n");
        const ProcessResult result = carom({"check", scene});
        EXPECT_TRUE(contains(result.err, "the cue would reach into ball 2 at")) << result.err;
    }
    const std::string rail = folder_.write(
        "r.toml", "[[ball]]\nid = \"cue\"\nposition = [0.06, 1.0]\n[cue]\nspeed = 3\naim_deg = 0\n");
    EXPECT_TRUE(contains(carom({"check", rail}).err, "the cue would reach into cushion c3 at"));
}

TEST_F(CliAnswers, AThreeCushionPointIsJudgedWithItsState) {
    const ProcessResult result =
        carom({"judge", three_cushion(), "--state", CAROM_SOURCE_DIR "/examples/games/three_cushion.json"});
    EXPECT_TRUE(contains(result.out, "1 point scored")) << result.out << result.err;
}

}  // namespace
}  // namespace carom::test
