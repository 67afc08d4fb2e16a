// carom-lab margin: output and files beyond `carom margin`.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lab_cli.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

class CliLabMargin : public ::testing::Test {
  protected:
    TemporaryFolder folder_;
    std::string scene_ = folder_.write("s.toml", kSmallScene);
};

TEST_F(CliLabMargin, ATraceHasEveryFrameAndEvent) {
    const ProcessResult result =
        carom_lab({"margin", scene_, "--fps", "20", "--no-render", "--trace", folder_.file("t.json")});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json trace = Json::parse(read_file(folder_.file("t.json"))).at("traceEvents");
    int frames = 0, events = 0;
    double end = 0.0;
    for (const Json& e : trace) {
        EXPECT_EQ(e.at("ph"), "X");
        const double ts = e.at("ts").get<double>(), dur = e.at("dur").get<double>();
        EXPECT_GE(dur, 0.0);
        events += e.at("cat") == "event" ? 1 : 0;
        if (e.at("cat") != "frame") continue;
        EXPECT_GE(ts, end - 1e-6) << "frames overlap";
        EXPECT_GE(ts, frames * 50000.0 - 1e-6);
        end = ts + dur;
        ++frames;
    }
    EXPECT_EQ(events, Json::parse(carom({"simulate", scene_, "--json"}).out).at("events").get<int>());
    EXPECT_GT(frames, 20);
}

TEST_F(CliLabMargin, SweepVariesAccuracyAndFrameRate) {
    ProcessResult result =
        carom_lab({"margin", scene_, "--sweep", "--no-render", "--json", "--csv", folder_.file("s.csv")});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json json = Json::parse(result.out);
    EXPECT_EQ(json.at("rows").size(), 8u * 6u);
    EXPECT_EQ(json.at("frontier").size(), 8u);
    for (const Json& row : json.at("rows")) {
        EXPECT_LE(row.at("missed").get<long>(), row.at("frames").get<long>());
        EXPECT_EQ(row.at("missed").get<long>() > 0,
                  row.at("worst_ms").get<double>() > row.at("budget_ms").get<double>());
    }
    EXPECT_EQ(lines_of(read_file(folder_.file("s.csv"))).size(), 8u * 6u + 1u);
    result = carom_lab({"margin", scene_, "--sweep", "--no-render", "--plot", folder_.file("s.svg")});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("tolerance 1e-06: "), std::string::npos) << result.out;
    EXPECT_NE(read_file(folder_.file("s.svg")).find("1/fps"), std::string::npos);
}

// A model without settings has one row per frame rate; drawing costs something in every frame.
TEST_F(CliLabMargin, SweepOfAClosedFormWithDrawing) {
    const std::string scene = folder_.write(
        "i.toml", std::string(kSmallScene) + "[physics]\nball_ball = \"inelastic\"\n[stop]\ntime = 0.2\n");
    const ProcessResult result = carom_lab({"margin", scene, "--sweep", "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json json = Json::parse(result.out);
    EXPECT_EQ(json.at("rows").size(), 6u);
    for (const Json& row : json.at("rows"))
        EXPECT_GT(row.at("worst_ms").get<double>(), row.at("worst_simulate_ms").get<double>());
}

}  // namespace
}  // namespace carom::test
