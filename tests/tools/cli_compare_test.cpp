// carom compare: its output and exit status.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

class Compare : public testing::Test {
  protected:
    /// The scene with another cue speed.
    std::string faster(const std::string& speed) {
        std::string text = kSmallScene;
        text.replace(text.find("4.0"), 3, speed);
        return folder_.write("faster.toml", text);
    }
    static Json json_of(std::vector<std::string> arguments, int status) {
        arguments.insert(arguments.begin(), "compare");
        arguments.emplace_back("--json");
        const ProcessResult result = carom(arguments);
        EXPECT_EQ(result.status, status) << result.err;
        EXPECT_EQ(lines_of(result.out).size(), 1u);
        return Json::parse(result.out);
    }

    TemporaryFolder folder_;
    std::string scene_ = folder_.write("s.toml", kSmallScene);
};

TEST_F(Compare, ASceneAndItsRecordAreTheSameBitForBit) {
    const std::string record = folder_.file("r.json");
    ASSERT_EQ(carom({"simulate", scene_, "-o", record}).status, 0);
    for (const auto& [a, b] :
         {std::pair(scene_, record), {record, scene_}, {record, record}, {scene_, scene_}}) {
        const ProcessResult result = carom({"compare", a, b, "--tolerance", "0"});
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(lines_of(result.out).back(), "the same, bit for bit");
        EXPECT_TRUE(contains(result.out, "matching: all, at the same times\n")) << result.out;
        EXPECT_EQ(result.err, "");
    }
    const Json same = json_of({scene_, record}, 0);
    EXPECT_EQ(same["same_bits"], true);
    EXPECT_EQ(same["equal"], true);
    EXPECT_EQ(same["a"]["hash"], same["b"]["hash"]);
    EXPECT_EQ(same["a"]["hash"].get<std::string>() + "\n", carom({"simulate", scene_, "--hash"}).out);
}

TEST_F(Compare, AnotherShotYieldsATableAndAStatus) {
    const std::string other = faster("4.4");
    const ProcessResult result = carom({"compare", scene_, other});
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.err, "");
    const std::vector<std::string> lines = lines_of(result.out);
    EXPECT_EQ(lines[0].find("A  " + scene_ + ": 3 balls, "), 0u) << result.out;
    EXPECT_EQ(lines[1].find("B  " + other + ": 3 balls, "), 0u) << result.out;
    const Json json = json_of({scene_, other}, 1);
    EXPECT_EQ(json["same_bits"], false);
    EXPECT_EQ(json["equal"], false);
    EXPECT_EQ(json["tolerance"], 1e-4);
    EXPECT_EQ(json["only_in_a"], Json::array());
    ASSERT_EQ(json["balls"].size(), 3u);
    // One row per ball, with the JSON's numbers.
    for (const Json& ball : json["balls"]) {
        const std::string id = ball["id"];
        std::string row;
        for (const std::string& line : lines)
            if (line.find("  " + id + " ") == 0) row = line;
        char numbers[64];
        std::snprintf(numbers, sizeof numbers, "%11.3g%13.3g", ball["end"].get<double>(),
                      ball["largest"].get<double>());
        EXPECT_TRUE(contains(row, numbers)) << row << numbers;
        EXPECT_EQ(row.back() == '*', !ball["equal"].get<bool>()) << row;
        EXPECT_GE(ball["largest"].get<double>(), ball["end"].get<double>());
    }
    const Json& events = json["events"];
    EXPECT_EQ(events["first_apart"]["number"], 2) << events;
    EXPECT_EQ(events["first_apart"]["a"]["type"], events["first_apart"]["b"]["type"]);
    EXPECT_GT(events["first_apart"]["a"]["time"], events["first_apart"]["b"]["time"])
        << "the faster ball is there earlier";
    EXPECT_TRUE(contains(result.out, "event 2 is the first at a different time: ")) << result.out;
    EXPECT_EQ(lines.back().find("different: 2 of 3 balls more than 0.0001 m apart, the farthest "), 0u)
        << lines.back();
}

TEST_F(Compare, TheToleranceDecidesTheStatus) {
    const std::string other = faster("4.0000001");
    const double largest = [&] {
        double most = 0.0;
        const Json json = json_of({scene_, other}, 0);
        for (const Json& ball : json["balls"]) most = std::max(most, ball["largest"].get<double>());
        return most;
    }();
    EXPECT_GT(largest, 0.0);
    EXPECT_LT(largest, 1e-4);
    for (const auto& [factor, status] : {std::pair(1.01, 0), {0.99, 1}}) {
        const ProcessResult result =
            carom({"compare", scene_, other, "--tolerance", std::to_string(1e9 * factor * largest) + "e-9"});
        EXPECT_EQ(result.status, status) << result.out;
        EXPECT_EQ(lines_of(result.out).back().find(status == 0 ? "equal within " : "different: "), 0u)
            << result.out;
    }
    EXPECT_EQ(carom({"compare", scene_, other, "--tolerance", "0"}).status, 1);
}

TEST_F(Compare, OtherBallsAreListedAndTheRestIsCompared) {
    std::string text = kSmallScene;
    text.replace(text.find("\"ball 2\""), 8, "\"3\"");
    const std::string other = folder_.write("other.toml", text);
    const ProcessResult result = carom({"compare", scene_, other});
    EXPECT_EQ(result.status, 1);
    EXPECT_TRUE(contains(result.out, "\nballs only in A: ball 2\nballs only in B: 3\n")) << result.out;
    EXPECT_TRUE(
        contains(result.out, "\ndifferent: not the same balls; the common ones are equal within 0.0001 m"))
        << result.out;
    EXPECT_EQ(json_of({scene_, other}, 1)["only_in_b"], Json::array({"3"}));
    const std::string none = folder_.write("none.toml", "[[ball]]\nid = \"x\"\n");
    EXPECT_EQ(lines_of(carom({"compare", scene_, none}).out).back(), "different: no ball in common");
}

TEST_F(Compare, AStoppedShotIsComparedUpToItsEnd) {
    const std::string record = folder_.file("r.json");
    ASSERT_EQ(carom({"simulate", scene_, "--until", "0.5", "-o", record}).status, 0);
    const ProcessResult result = carom({"compare", scene_, record});
    EXPECT_EQ(result.status, 1);
    EXPECT_TRUE(contains(result.out, "\n  largest: until 0.5000 s, when one of the shots was stopped\n"))
        << result.out;
    EXPECT_TRUE(contains(result.out, " m at the end")) << result.out;
    const Json json = json_of({scene_, record}, 1);
    EXPECT_EQ(json["until"], 0.5);
    for (const Json& ball : json["balls"]) EXPECT_EQ(ball["largest"], 0.0);
    EXPECT_TRUE(json["events"]["first_other"]["b"].is_null()) << json["events"];
}

TEST_F(Compare, AllShippedScenesEqualThemselves) {
    for (const std::string& scene : shipped_scenes()) {
        const Json same = json_of({scene, scene, "--tolerance", "0"}, 0);
        EXPECT_EQ(same["same_bits"], true) << scene;
        EXPECT_TRUE(same["events"]["first_other"].is_null()) << scene;
    }
}

}  // namespace
}  // namespace carom::test
