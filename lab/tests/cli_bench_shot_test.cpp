// carom-lab bench shot: its output. No test asserts a measured time; events and bytes are counts.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "lab_cli.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

TEST(CliBenchShot, RowsAreComplete) {
    const ProcessResult result = carom_lab_isa(
        "scalar", {"bench", "shot", "--json", "--seeds", "2", "--repeat", "1", "--events", "200"});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json json = Json::parse(result.out);
    const double baseline = json.at("baseline_ns").get<double>();
    EXPECT_EQ(json.at("machine").at("isa"), "scalar");
    std::set<std::string> names;
    for (const Json& row : json.at("rows")) {
        names.insert(row.at("name"));
        const auto value = [&row](const char* key) { return row.at(key).get<double>(); };
        // Relations that hold for any times; the median of two seeds is their mean.
        EXPECT_LE(value("cost_least"), value("cost_in_impacts"));
        EXPECT_LE(value("cost_in_impacts"), value("cost_most"));
        EXPECT_LE(value("ns_min"), value("ns_median"));
        EXPECT_NEAR(value("cost_in_impacts") * baseline, value("ns_min"), 1e-9 * value("ns_min"));
        EXPECT_NEAR(value("ns_per_event") * value("events"), value("ns_min"), 1e-9 * value("ns_min"));
        const bool many = row.at("name").get<std::string>().rfind("many ", 0) == 0;
        EXPECT_EQ(row.at("shots_per_cpu_s").is_null(), !many) << row.at("name");
        if (many) {
            EXPECT_NEAR(value("shots_per_cpu_s") * value("ns_min"), 1e9, 1.0);
            EXPECT_TRUE(row.at("detect_ns").is_null());
            EXPECT_GT(value("events"), 4.0);
            continue;
        }
        // Parts present in every shot's events.
        for (const char* part : {"detect_ns", "resolve_ns", "kernel_ns", "queue_ns"})
            EXPECT_GT(value(part), 0.0) << row.at("name") << " " << part;
        const bool compliant = row.at("name") == "eight_ball_break compliant";
        EXPECT_EQ(row.at("clusters").get<double>() > 0.0, compliant);
        EXPECT_EQ(row.at("cluster_ns").get<double>() > 0.0, compliant);
        EXPECT_GT(row.at("events").get<double>(), row.at("name") == "two_ball_shot" ? 5.0 : 50.0);
    }
    EXPECT_EQ(names, (std::set<std::string>{"eight_ball_break", "nine_ball_break",
                                            "eight_ball_break compliant", "two_ball_shot", "many two_ball",
                                            "many three_cushion", "many eight_ball_break",
                                            "many drawn_eight_ball", "many drawn_nine_ball"}));
    std::set<int> sizes, chosen, compliant;
    std::map<std::string, double> first_ns;  // growth is relative to the smallest gas of the same model
    for (const Json& row : json.at("growth")) {
        const int n = row.at("n").get<int>();
        sizes.insert(n);
        const bool by_default = row.at("clusters") == "compliant";
        EXPECT_EQ(row.at("name"), by_default ? "gas compliant" : "gas");
        if (row.at("chosen").get<bool>()) {
            EXPECT_TRUE((by_default ? compliant : chosen).insert(n).second) << n;
        }
        if (n == 16 && row.at("search") == "direct") {
            EXPECT_EQ(row.at("growth").get<double>(), 1.0);
        }
        EXPECT_TRUE(row.at("search") == "direct" || row.at("search") == "tree");
        EXPECT_LE(row.at("ns_min").get<double>(), row.at("ns_median").get<double>());
        const double ns = row.at("ns_min").get<double>();
        const double first = first_ns.emplace(row.at("name").get<std::string>(), ns).first->second;
        EXPECT_NEAR(row.at("growth").get<double>() * first, row.at("ns_min").get<double>(),
                    1e-9 * row.at("ns_min").get<double>());
        if (n == 10000) {
            EXPECT_LT(row.at("bytes_per_ball").get<double>(), 1000.0);
        }
    }
    EXPECT_EQ(sizes, (std::set<int>{16, 100, 300, 1000, 10000}));
    EXPECT_EQ(chosen, sizes);
    EXPECT_EQ(compliant, sizes);
}

TEST(CliBenchShot, PrintsATable) {
    const ProcessResult result =
        carom_lab_isa("scalar", {"bench", "shot", "--seeds", "1", "--repeat", "1", "--no-growth"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("two_ball_shot"), std::string::npos);
    EXPECT_EQ(result.out.find("bytes/ball"), std::string::npos);
}

TEST(CliBenchShot, RefusesBadUsage) {
    EXPECT_EQ(carom_lab({"bench", "shot", "--seeds", "0"}).status, 2);
    EXPECT_EQ(carom_lab({"bench", "shot", "--events", "5"}).status, 2);
    EXPECT_EQ(carom_lab({"bench", "shot", "--what"}).status, 2);
    EXPECT_EQ(carom_lab_isa("v5", {"bench", "shot", "--no-growth"}).status, 2);
}

}  // namespace
}  // namespace carom::test
