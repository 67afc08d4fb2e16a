// carom bench kernel: what it prints. Times are measured, and no test asserts one; counts and differences are
// the kernel's.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "carom/kernel/isa.h"
#include "cli.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

TEST(CliBench, KernelRowsAreWhole) {
    const ProcessResult result =
        carom_isa("scalar", {"bench", "kernel", "--json", "--random", "40", "--repeat", "1"});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json json = Json::parse(result.out);
    EXPECT_GT(json.at("baseline_ns").get<double>(), 0.0);
    EXPECT_TRUE(json.at("machine").is_object());
    std::set<std::string> names;
    for (const Json& row : json.at("rows")) {
        names.insert(row.at("name"));
        EXPECT_EQ(row.at("isa"), "scalar");
        for (const char* number :
             {"ratio", "ratio_random", "ns_min", "ns_median", "diff_five", "diff_random_max", "error_five",
              "error_random_median", "error_random_max", "cycles_per_step"})
            EXPECT_TRUE(row.at(number).is_number()) << number;
        EXPECT_TRUE(row.at("portable_bits").is_boolean());
        EXPECT_TRUE(row.at("kind") == "single" || row.at("kind") == "batch");
        // The march is a step of the approach speed / N from the converged solution, plus what sticks.
        EXPECT_LT(row.at("error_five").get<double>(), 2e-3);
        if (row.at("name") == "march baseline") {
            EXPECT_EQ(row.at("diff_five").get<double>(), 0.0);
            EXPECT_EQ(row.at("same_steps").get<int>(), 40);
        }
    }
    for (const char* name : {"march baseline", "march summed", "march reduced state", "tolerance 1e-3",
                             "tolerance 1e-6", "tolerance 1e-10"})
        EXPECT_TRUE(names.count(name)) << name;
    std::set<int> grown;
    for (const Json& row : json.at("growth")) grown.insert(row.at("n").get<int>());
    EXPECT_EQ(grown, (std::set<int>{100, 1000, 10000}));
    EXPECT_FALSE(json.at("shares").empty());
}

TEST(CliBench, PrintsATable) {
    const ProcessResult result =
        carom_isa("scalar", {"bench", "kernel", "--random", "10", "--repeat", "1", "--no-growth"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("march summed"), std::string::npos);
}

TEST(CliBench, RefusesBadUsage) {
    EXPECT_EQ(carom({"bench"}).status, 2);
    EXPECT_EQ(carom({"bench", "nothing"}).status, 2);
    EXPECT_EQ(carom({"bench", "kernel", "--random", "0"}).status, 2);
    EXPECT_EQ(carom_isa("v5", {"bench", "kernel"}).status, 2);
}

}  // namespace
}  // namespace carom::test
