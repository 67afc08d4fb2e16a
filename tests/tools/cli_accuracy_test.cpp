// carom accuracy: its output and files. No test asserts a measured time; errors are repeatable.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

class CliAccuracyScene : public ::testing::Test {
  protected:
    TemporaryFolder folder_;
    std::string scene_ = folder_.write("s.toml", kSmallScene);

    ProcessResult quick(std::vector<std::string> more = {}) const {
        std::vector<std::string> all = {"accuracy", scene_,      "--repeat",    "1",
                                        "--march",  "100,10000", "--tolerance", "1e-3,1e-6,1e-9"};
        all.insert(all.end(), more.begin(), more.end());
        return carom(all);
    }
};

TEST_F(CliAccuracyScene, ThePlotMarksTheRecommendedTolerance) {
    const ProcessResult result = quick({"--plot", folder_.file("a.svg")});
    ASSERT_EQ(result.status, 0) << result.err;
    const std::string svg = read_file(folder_.file("a.svg"));
    for (const char* part : {"<svg", "recommended: 1e-0", "target 0.001 m", "march published"})
        EXPECT_NE(svg.find(part), std::string::npos) << part;
    EXPECT_EQ(quick({"--plot", folder_.file("a.txt")}).status, 2);
}

TEST_F(CliAccuracyScene, JsonHasGainErrorsAndARecommendation) {
    const ProcessResult result = quick({"--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json json = Json::parse(result.out);
    EXPECT_TRUE(json.at("converged").get<bool>());
    EXPECT_GT(json.at("gain").get<double>(), 1.0);
    EXPECT_EQ(json.at("target"), 1e-3);
    const double recommended = json.at("recommended_tolerance").get<double>();
    std::vector<std::string> names;
    double loosest = 0.0;
    for (const Json& row : json.at("rows")) {
        names.push_back(row.at("method").get<std::string>() + " " + row.at("setting").get<std::string>());
        EXPECT_GT(row.at("ns").get<double>(), 0.0);
        EXPECT_TRUE(row.at("same_first_contact").is_boolean());
        if (row.at("method") != "tolerance") continue;
        const double tolerance = std::stod(row.at("setting").get<std::string>());
        const double error = row.at("error_max").get<double>();
        if (tolerance == recommended) {
            EXPECT_LE(error, 1e-3);
        }
        if (tolerance == 1e-3) loosest = error;
        if (tolerance == 1e-9) {
            EXPECT_LT(error, loosest);
        }
    }
    EXPECT_EQ(names[0], "march N=100");
    EXPECT_EQ(names.back(), "tolerance 1e-09");
    EXPECT_EQ(json.at("recommendation").get<std::string>().substr(0, 10), "Tolerance ");
}

TEST_F(CliAccuracyScene, ErrorsAreRepeatable) {
    const Json a = Json::parse(quick({"--json"}).out), b = Json::parse(quick({"--json"}).out);
    EXPECT_EQ(a.at("gain"), b.at("gain"));
    EXPECT_EQ(a.at("recommended_tolerance"), b.at("recommended_tolerance"));
    for (std::size_t i = 0; i < a.at("rows").size(); ++i)
        EXPECT_EQ(a.at("rows")[i].at("error_max"), b.at("rows")[i].at("error_max"));
}

TEST_F(CliAccuracyScene, ATargetBeyondDoublePrecisionIsReported) {
    const ProcessResult result = quick({"--target", "1e-13", "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json json = Json::parse(result.out);
    EXPECT_TRUE(json.at("recommended_tolerance").is_null());
    const std::string words = json.at("recommendation");
    EXPECT_TRUE(words.find("Double precision does not allow") == 0 ||
                words.find("differences here are not errors") != std::string::npos)
        << words;
}

TEST_F(CliAccuracyScene, TableAndCsv) {
    const ProcessResult result = quick({"--csv", folder_.file("a.csv"), "--target", "0.01"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("Gain "), std::string::npos);
    EXPECT_NE(result.out.find("is enough for 0.01 m"), std::string::npos) << result.out;
    EXPECT_GE(lines_of(read_file(folder_.file("a.csv"))).size(), 6u);
}

}  // namespace
}  // namespace carom::test
