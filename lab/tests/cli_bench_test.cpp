// carom-lab bench kernel: its output. No test asserts a measured time; counts and differences are the
// kernel's.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "carom/kernel/isa.h"
#include "lab_cli.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

// Two forms; bench_kernel_test checks the names of all.
TEST(CliBench, KernelRowsAreComplete) {
    const ProcessResult result =
        carom_lab_isa("scalar", {"bench", "kernel", "--json", "--random", "40", "--repeat", "2", "--only",
                                 "march reduced", "--only", "tolerance 1e-6", "--only", "march baseline"});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json json = Json::parse(result.out);
    const auto value = [](const Json& row, const char* key) { return row.at(key).get<double>(); };
    const double baseline = value(json, "baseline_ns"), cycle = value(json.at("machine"), "cycle_ns");
    EXPECT_EQ(json.at("machine").at("random"), 40);
    std::vector<std::string> names;
    for (const Json& row : json.at("rows")) {
        names.push_back(row.at("name").get<std::string>() + ", " + row.at("kind").get<std::string>());
        const bool march = names.back().rfind("march", 0) == 0;
        EXPECT_EQ(row.at("isa"), "scalar");
        EXPECT_EQ(row.at("portable_bits"), true);
        // Relations that hold for any times.
        EXPECT_LE(value(row, "ns_min"), value(row, "ns_median"));
        EXPECT_NEAR(value(row, "ratio") * value(row, "ns_min"), baseline, 1e-9 * baseline);
        EXPECT_NEAR(value(row, "ratio_random") * value(row, "ns_random_min"),
                    value(json, "baseline_random_ns"), 1e-9 * value(json, "baseline_random_ns"));
        EXPECT_NEAR(value(row, "cycles_per_step") * value(row, "steps") * cycle, value(row, "ns_min"),
                    1e-9 * value(row, "ns_min"));
        // The march is within a step, the approach speed / N, of the converged solution, plus the effect of
        // sticking.
        EXPECT_LT(value(row, "error_five"), march ? 2e-3 : 1e-6);
        EXPECT_LE(value(row, "error_random_median"), value(row, "error_random_max"));
        EXPECT_LE(value(row, "diff_random_p99"), value(row, "diff_random_max"));
        if (march) {
            EXPECT_EQ(row.at("same_steps").get<int>(), 40);
            EXPECT_GT(value(row, "error_five"), 1e-5);
            EXPECT_LT(value(row, "diff_five"), 1e-12);
        } else {
            EXPECT_LT(value(row, "error_random_max"), 1e-6);
        }
        if (row.at("name") == "march baseline") {
            EXPECT_EQ(value(row, "diff_five"), 0.0);
            EXPECT_EQ(value(row, "diff_random_max"), 0.0);
            EXPECT_EQ(row.at("section"), "3.1");
        }
    }
    EXPECT_EQ(names, (std::vector<std::string>{"march baseline, single", "march reduced state, single",
                                               "tolerance 1e-6, single", "tolerance 1e-6, batch"}));
    std::map<std::string, std::multiset<int>> grown;
    for (const Json& row : json.at("growth")) {
        grown[row.at("name")].insert(row.at("n").get<int>());
        EXPECT_LE(value(row, "ns_min"), value(row, "ns_median"));
    }
    const std::multiset<int> once{100, 1000, 10000}, twice{100, 100, 1000, 1000, 10000, 10000};
    EXPECT_EQ(grown,
              (std::map<std::string, std::multiset<int>>{
                  {"march baseline", once}, {"march reduced state", once}, {"tolerance 1e-6", twice}}));
    std::vector<std::string> shared;
    for (const Json& row : json.at("shares")) {
        shared.push_back(row.at("name"));
        EXPECT_NEAR(value(row, "before_ns") + value(row, "loop_ns") + value(row, "after_ns"),
                    value(row, "warm_ns"), 1e-9 * value(row, "warm_ns"));
    }
    EXPECT_EQ(shared, (std::vector<std::string>{"march baseline", "march reduced state"}));
}

TEST(CliBench, PrintsATable) {
    const ProcessResult result =
        carom_lab_isa("scalar", {"bench", "kernel", "--random", "10", "--repeat", "1", "--no-growth",
                                 "--only", "march summed", "--only", "tolerance 1e-3"});
    EXPECT_EQ(result.status, 0) << result.err;
    int summed = 0, tolerance = 0;
    for (const std::string& line : lines_of(result.out)) {
        summed += line.rfind("march summed  ", 0) == 0;
        tolerance += line.rfind("tolerance 1e-3 ", 0) == 0;
        EXPECT_EQ(line.rfind("march baseline", 0), line.npos) << line;
    }
    EXPECT_EQ(summed, 2) << result.out;     // its row, and its shares
    EXPECT_EQ(tolerance, 2) << result.out;  // one by one, and as a batch
    EXPECT_EQ(result.out.find("growth"), std::string::npos);
}

TEST(CliBench, AnUnknownFormIsRefusedWithTheKnownNames) {
    for (const char* name : {"march nothing", "march reduced stat", "tolerance 1e-1", "", "fma"}) {
        const ProcessResult result =
            carom_lab_isa("scalar", {"bench", "kernel", "--only", "march baseline", "--only", name});
        EXPECT_EQ(result.status, 2) << name;
        EXPECT_EQ(result.out, "") << name;
        EXPECT_NE(result.err.find("--only: there is no form \"" + std::string(name) + "\""),
                  std::string::npos)
            << result.err;
        EXPECT_NE(result.err.find("march reduced state, "), std::string::npos) << result.err;
        EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
    }
}

TEST(CliBench, RefusesBadUsage) {
    EXPECT_EQ(carom_lab({"bench"}).status, 2);
    EXPECT_EQ(carom_lab({"bench", "nothing"}).status, 2);
    EXPECT_EQ(carom_lab({"bench", "kernel", "--random", "0"}).status, 2);
    EXPECT_EQ(carom_lab_isa("v5", {"bench", "kernel"}).status, 2);
}

TEST(CliBenchRender, PrintsItsRows) {
    const TemporaryFolder folder;
    const std::string scene_ = folder.write("s.toml", kSmallScene);
    EXPECT_EQ(carom_lab({"bench", "render", scene_, "--frames", "2"}).status, 2);
    const ProcessResult rows = carom_lab({"bench", "render", scene_, "--frames", "3", "--json"});
    ASSERT_EQ(rows.status, 0) << rows.err;
    const auto json = nlohmann::json::parse(rows.out);
    std::vector<std::string> names;
    for (const auto& row : json.at("rows")) names.push_back(row.at("name"));
    EXPECT_EQ(names, (std::vector<std::string>{"720p", "1080p", "1080p follow", "2160p"}));
    EXPECT_EQ(json.at("rows")[2].at("encoded_share"), 1.0);  // its camera moves
    EXPECT_LT(json.at("rows")[3].at("encoded_share"), 0.5);
    for (const auto& row : json.at("rows")) {
        for (const char* figure : {"draw_ms", "readback_ms", "draw_readback_p95_ms", "encode_ms",
                                   "encoded_share", "write_ms", "setup_ms", "cpu_ms", "fps"})
            EXPECT_GT(row.at(figure).get<double>(), 0.0) << figure;
    }
}

}  // namespace
}  // namespace carom::test
