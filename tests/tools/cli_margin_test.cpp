// carom margin: its output and files. No test asserts a measured time.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

class CliMargin : public ::testing::Test {
  protected:
    TemporaryFolder folder_;
    std::string scene_ = folder_.write("s.toml", kSmallScene);
};

TEST_F(CliMargin, ThePlotNamesTheWorstFrame) {
    const ProcessResult result =
        carom({"margin", scene_, "--fps", "20", "--no-render", "--plot", folder_.file("m.svg")});
    ASSERT_EQ(result.status, 0) << result.err;
    const std::string svg = read_file(folder_.file("m.svg"));
    for (const char* part : {"<svg", "simulate", "ball_ball", "ball_cushion", "1/20 s", "worst frame: "})
        EXPECT_NE(svg.find(part), std::string::npos) << part;
    const ProcessResult png =
        carom({"margin", scene_, "--fps", "20", "--no-render", "--plot", folder_.file("m.png")});
    if (contains(png.err, "draws only .svg")) GTEST_SKIP() << "this build has no cairo";
    ASSERT_EQ(png.status, 0) << png.err;
    EXPECT_TRUE(read_file(folder_.file("m.png")).starts_with("\x89PNG\r\n"));
}

void expect_margin_json(const Json& json, bool rendered) {
    EXPECT_EQ(json.at("fps"), 20.0);
    EXPECT_EQ(json.at("budget_ms"), 50.0);
    const Json& stages = json.at("stages");
    ASSERT_EQ(stages.size(), 9u);
    for (const char* stage :
         {"simulate", "detect", "resolve", "kernel", "cluster", "draw", "readback", "encode", "write"}) {
        const std::string name = stage;
        const bool drawn = name == "draw" || name == "readback" || name == "encode" || name == "write";
        if (drawn && !rendered) {
            EXPECT_TRUE(stages.at(stage).is_null()) << stage;
            continue;
        }
        const Json& values = stages.at(stage);
        ASSERT_EQ(values.size(), 4u) << stage;
        EXPECT_LE(values.at("p50").get<double>(), values.at("p95").get<double>());
        EXPECT_LE(values.at("p95").get<double>(), values.at("p99").get<double>());
        EXPECT_LE(values.at("p99").get<double>(), values.at("max").get<double>());
        if (name != "cluster") {
            EXPECT_GT(values.at("max").get<double>(), 0.0) << stage;
        }
    }
    EXPECT_EQ(stages["cluster"]["max"].get<double>(), 0.0);  // distant balls: none hits two at once
    EXPECT_LE(stages["kernel"]["max"].get<double>(), stages["simulate"]["max"].get<double>());
    const Json& worst = json.at("worst");
    ASSERT_EQ(worst.size(), 4u);
    EXPECT_EQ(worst.at("time").get<double>(), worst.at("frame").get<double>() / 20.0);
    EXPECT_GT(worst.at("ms").get<double>(), 0.0);
    for (const Json& event : worst.at("events")) EXPECT_TRUE(event.at("type").is_string());
    EXPECT_LE(json.at("slack_percent").at("least").get<double>(),
              json.at("slack_percent").at("median").get<double>());
    EXPECT_DOUBLE_EQ(json.at("slack_percent").at("least").get<double>(),
                     100.0 * (1.0 - worst.at("ms").get<double>() / 50.0));
    EXPECT_GT(json.at("timing").at("clock_ns").get<double>(), 0.0);
    // A process cannot last shorter than its parts.
    const Json& process = json.at("process");
    double parts = 0.0;
    for (const char* part : {"start_ms", "setup_ms", "first_frames_ms", "frames_ms", "timing_ms"})
        parts += process.at(part).get<double>();
    EXPECT_NEAR(parts, process.at("parts_ms").get<double>(), 1e-9 * parts);
    EXPECT_LE(parts, process.at("wall_ms").get<double>());
    EXPECT_EQ(process.at("setup_ms").get<double>() > 0.0, rendered);
    EXPECT_GT(process.at("first_frames_ms").get<double>(), 0.0);
    EXPECT_EQ(json.at("runs").at("first").at("max")[0], json.at("runs").at("first").at("max")[1]);
}

TEST_F(CliMargin, JsonHasTheDocumentedShape) {
    const ProcessResult result =
        carom({"margin", scene_, "--fps", "20", "--json", "--repeat", "2", "--csv", folder_.file("m.csv")});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json json = Json::parse(result.out);
    expect_margin_json(json, true);
    EXPECT_EQ(json.at("runs").at("count"), 2);
    EXPECT_GT(json.at("encoded_share").at("p50").get<double>(), 0.0);
    EXPECT_LT(json.at("encoded_share").at("p50").get<double>(), 0.5);
    EXPECT_EQ(json.at("encoded_share").at("max"), 1.0);  // the first frame
    EXPECT_LE(json.at("runs").at("p99")[0].get<double>(), json.at("runs").at("p99")[1].get<double>());
    const std::vector<std::string> lines = lines_of(read_file(folder_.file("m.csv")));
    EXPECT_EQ(lines.at(0),
              "frame,time,events,simulate_ms,detect_ms,resolve_ms,kernel_ms,cluster_ms,draw_ms,readback_ms,"
              "encode_ms,write_ms,total_ms,slack_percent,missed");
    EXPECT_EQ(lines.size(), json.at("frames").get<std::size_t>() + 1);
}

TEST_F(CliMargin, WrittenFramesAreRemoved) {
    ProcessOptions options;
    options.environment = {{"TMPDIR", folder_.path().string()}};
    ASSERT_EQ(carom({"margin", scene_, "--fps", "5"}, options).status, 0);
    EXPECT_EQ(folder_.names(), std::vector<std::string>{"s.toml"});
}

TEST_F(CliMargin, WithoutRenderingCountsEveryEventOnce) {
    const ProcessResult result =
        carom({"margin", scene_, "--fps", "20", "--json", "--no-render", "--csv", folder_.file("m.csv")});
    ASSERT_EQ(result.status, 0) << result.err;
    expect_margin_json(Json::parse(result.out), false);
    const std::vector<std::string> lines = lines_of(read_file(folder_.file("m.csv")));
    EXPECT_EQ(
        lines.at(0),
        "frame,time,events,simulate_ms,detect_ms,resolve_ms,kernel_ms,cluster_ms,total_ms,slack_percent,"
        "missed");
    int events = 0, quiet = 0;
    for (std::size_t i = 1; i < lines.size(); ++i) {
        int here = -1;
        ASSERT_EQ(std::sscanf(lines[i].c_str(), "%*d,%*f,%d,", &here), 1) << lines[i];
        events += here;
        quiet += here == 0 ? 1 : 0;
    }
    const Json json = Json::parse(result.out);
    EXPECT_EQ(json.at("without_event"), quiet);
    EXPECT_EQ(json.at("runs").at("count"), 3);
    EXPECT_EQ(json.at("runs").at("warm").size(), 6u);
    EXPECT_EQ(events, Json::parse(carom({"simulate", scene_, "--json"}).out).at("events").get<int>());
}

TEST_F(CliMargin, TheSummaryIsReadable) {
    const ProcessResult result =
        carom({"margin", scene_, "--size", "160x90", "--fps", "20", "--repeat", "2"});
    ASSERT_EQ(result.status, 0) << result.err;
    for (const char* part : {" missed\n",         "\n  simulate ", "\n    kernel ",    "\n    cluster ",
                             "\n  draw ",         "\n  readback ", "\n  encode ",      "\n  write ",
                             "\n  all ",          "Slack: ",       "Without encoding", "first run: p50 ",
                             "warm runs: p50 ",   "set-up ",       "frame 0 ",         "Medians of 2 runs",
                             " have no event.\n", " 2 runs: p99 ", " ms add up to ",   "Cost of timing: ",
                             "worst frame: "}) {
        EXPECT_NE(result.out.find(part), std::string::npos) << part << "\n" << result.out;
    }
}

}  // namespace
}  // namespace carom::test
