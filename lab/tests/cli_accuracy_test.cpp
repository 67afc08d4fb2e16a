// carom-lab accuracy: its output and files. No test asserts a measured time; errors are repeatable.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lab_cli.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

const std::vector<std::string> kQuickKernel = {"accuracy", "kernel", "--count",         "40",  "--repeat",
                                               "1",        "--json", "--most-substeps", "1000"};

Json rows_of(const Json& json, const std::string& method, const std::string& kind) {
    Json rows = Json::array();
    for (const Json& row : json.at("rows"))
        if (row.at("method") == method && row.at("kind") == kind) rows.push_back(row);
    return rows;
}

TEST(CliAccuracyKernel, EveryMethodWithItsErrors) {
    const ProcessResult result = carom_lab(kQuickKernel);
    ASSERT_EQ(result.status, 0) << result.err;
    const Json json = Json::parse(result.out);
    EXPECT_EQ(json.at("impacts").get<int>() + json.at("disagreeing").get<int>(), 40);
    EXPECT_LT(json.at("agreement").get<double>(), 1e-11);
    for (const Json& row : json.at("rows")) {
        EXPECT_GT(row.at("ns").get<double>(), 0.0);
        EXPECT_LE(row.at("ns").get<double>(), row.at("ns_median").get<double>());
        EXPECT_LE(row.at("error_median").get<double>(), row.at("error_p99").get<double>());
        EXPECT_LE(row.at("error_p99").get<double>(), row.at("error_max").get<double>());
    }
    EXPECT_EQ(rows_of(json, "march", "single").size(), 5u);
    EXPECT_NEAR(json.at("slope").get<double>(), -1.0, 0.1);
    // The bound of the tolerance kernel, single and batch.
    for (const char* kind : {"single", "batch"}) {
        const Json rows = rows_of(json, "tolerance", kind);
        EXPECT_EQ(rows.size(), 11u);
        for (const Json& row : rows) EXPECT_LE(row.at("share_of_bound").get<double>(), 1.0) << row;
    }
    for (const Json& row : json.at("reach")) {
        if (row.at("method") != "tolerance") continue;
        EXPECT_TRUE(row.at("ns_median").is_number()) << row;
    }
}

TEST(CliAccuracyKernel, ErrorsAreRepeatable) {
    const Json a = Json::parse(carom_lab(kQuickKernel).out), b = Json::parse(carom_lab(kQuickKernel).out);
    for (const char* method : {"march", "tolerance"}) {
        const Json one = rows_of(a, method, "single"), two = rows_of(b, method, "single");
        ASSERT_EQ(one.size(), two.size());
        for (std::size_t i = 0; i < one.size(); ++i)
            for (const char* key : {"setting", "error_median", "error_p99", "error_max"})
                EXPECT_EQ(one[i].at(key), two[i].at(key)) << method << key;
    }
}

TEST(CliAccuracyKernel, TableCsvAndPlot) {
    const TemporaryFolder folder;
    const ProcessResult result =
        carom_lab({"accuracy", "kernel", "--count", "10", "--repeat", "1", "--most-substeps", "100", "--csv",
                   folder.file("a.csv"), "--plot", folder.file("a.svg")});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("ns to reach an error"), std::string::npos);
    const std::vector<std::string> csv = lines_of(read_file(folder.file("a.csv")));
    EXPECT_EQ(csv[0], "method,kind,setting,ns,ns_median,ns_max,error_median,error_p99,error_max");
    EXPECT_EQ(csv.size(), 1u + 3 * 3 + 2 * 11 + 2);
    EXPECT_EQ(read_file(folder.file("a.svg")).substr(0, 4), "<svg");
}

TEST(CliLabAccuracy, ASceneComparedWithBox2dAsPlotAndPage) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", kSmallScene);
    const ProcessResult result = carom_lab(
        {"accuracy", scene, "--repeat", "1", "--march", "100", "--tolerance", "1e-3,1e-6", "--target", "0.01",
         "--box2d", "--json", "--plot", folder.file("a.svg"), "--html", folder.file("a.html")});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json rows = Json::parse(result.out).at("rows");
    EXPECT_EQ(rows.back().at("method"), "box2d");
    EXPECT_EQ(rows.back().at("setting"), "10000 Hz");
    EXPECT_NE(read_file(folder.file("a.svg")).find("target 0.01 m"), std::string::npos);
    EXPECT_NE(read_file(folder.file("a.html")).find("Accuracy of "), std::string::npos);
}

TEST(CliLabAccuracy, RefusesBadUsage) {
    for (const auto& [arguments, message] : std::vector<std::pair<std::vector<std::string>, const char*>>{
             {{"accuracy", "kernel", "--count", "0"}, "--count"},
             {{"accuracy", "kernel", "--plot", "x.jpg"}, "x.jpg"},
             {{"accuracy", "none.toml", "--html", "x.png"}, "a name that ends in .html"},
             {{"margin", "none.toml", "--sweep", "--fps", "60"}, "--sweep goes through the frame rates"},
             {{"margin", "none.toml", "--sweep", "--trace", "t.json"}, "--trace is of one setting"},
             {{"bench"}, "no command given: expected discs, kernel, render or shot"}}) {
        const ProcessResult result = carom_lab(arguments);
        EXPECT_EQ(result.status, 2) << message;
        EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
        EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
    }
}

TEST(CliLabCompare, ThePathsOfTwoShotsInOnePicture) {
    const TemporaryFolder folder;
    const std::string scenes = CAROM_SOURCE_DIR "/scenes/";
    const ProcessResult result =
        carom_lab({"compare", scenes + "stop.toml", scenes + "draw.toml", "--plot", folder.file("w.svg")});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(read_file(folder.file("w.svg")).find("solid: A, dashed: B"), std::string::npos);
}

}  // namespace
}  // namespace carom::test
