// carom-lab validate: its output and files. validate_test.cpp checks the claims about the numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lab_cli.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

TEST(CliValidate, JsonHasARowPerNumberAndVariant) {
    const ProcessResult result = carom_lab({"validate", "V2", "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json json = Json::parse(result.out);
    ASSERT_EQ(json.size(), 1u);
    const Json& rows = json.at("cases");
    ASSERT_GE(rows.size(), 12u);
    for (const Json& row : rows) {
        EXPECT_EQ(row.at("case"), "V2");
        EXPECT_TRUE(row.at("preset").is_string());
        EXPECT_TRUE(row.at("model").is_string());
        const double measured = row.at("measured").get<double>(), computed = row.at("computed").get<double>(),
                     uncertainty = row.at("uncertainty").get<double>();
        EXPECT_EQ(row.at("within").get<bool>(), std::abs(computed - measured) <= uncertainty);
        EXPECT_DOUBLE_EQ(row.at("difference").get<double>(), (computed - measured) / uncertainty);
        EXPECT_TRUE(row.at("free_of_fit").is_boolean());
        EXPECT_TRUE(row.at("as_claimed").get<bool>());
        EXPECT_EQ(row.at("claim") == "within", row.at("within").get<bool>());
        EXPECT_EQ(row.at("unit"), "m/s");
        EXPECT_EQ(row.at("quantity"), "speed");
        EXPECT_EQ(row.at("trust"), "second hand");
        EXPECT_FALSE(row.at("source").get<std::string>().empty());
    }
    EXPECT_EQ(rows[0].at("measured"), 0.948);
    EXPECT_EQ(rows[0].at("model"), "mathavan_2010");
    EXPECT_EQ(rows[1].at("preset"), "snooker_classic");
    EXPECT_EQ(rows[1].at("model"), "han_2005");
}

// A number that misses is a finding, not a failure.
TEST(CliValidate, TheSummaryIsReadable) {
    const ProcessResult result = carom_lab({"validate", "V2"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const std::vector<std::string> lines = lines_of(result.out);
    EXPECT_EQ(lines.at(0).substr(0, 4), "V2  ");
    for (const char* part : {"second hand", "measured", "computed", "snooker_classic", "  *\n",
                             " within the uncertainty", "all as claimed\n"})
        EXPECT_TRUE(contains(result.out, part)) << part << "\n" << result.out;
}

TEST(CliValidate, ASharePlaysTheSameShotsEachTime) {
    const ProcessResult first = carom_lab({"validate", "V19", "--json"});
    ASSERT_EQ(first.status, 0) << first.err;
    EXPECT_EQ(first.out, carom_lab_isa("scalar", {"validate", "V19", "--json"}).out);
    const Json row = Json::parse(first.out).at("cases").at(0);
    EXPECT_TRUE(row.at("ball").is_null());
    EXPECT_EQ(row.at("quantity"), "share");
    EXPECT_EQ(row.at("kind"), "words");
    EXPECT_GT(row.at("uncertainty").get<double>(), 0.25);  // of the count, and of 300 shots
}

TEST(CliValidate, TableAndFiguresAsFiles) {
    const TemporaryFolder folder;
    for (const std::string id : {"V3", "V5", "V20"}) {
        const ProcessResult result =
            carom_lab({"validate", id, "--csv", folder.file("v.csv"), "--plot", folder.file("v.svg")});
        ASSERT_EQ(result.status, 0) << result.err;
        const std::vector<std::string> lines = lines_of(read_file(folder.file("v.csv")));
        EXPECT_EQ(lines.at(0).substr(0, 25), "case,title,shot,quantity,");
        EXPECT_EQ(lines.at(1).substr(0, id.size() + 1), id + ",");
        const std::string svg = read_file(folder.file("v.svg"));
        EXPECT_EQ(svg.substr(0, 4), "<svg");
        EXPECT_TRUE(contains(svg, ">" + id + ": ")) << svg;
        EXPECT_EQ(contains(svg, ">measured<"), id == "V3");
    }
}

TEST(CliValidate, AnUnknownCaseListsAllCases) {
    const ProcessResult result = carom_lab({"validate", "V99"});
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(contains(result.err, "carom-lab: validate: there is no case V99; the cases are V1, V2, "))
        << result.err;
    EXPECT_TRUE(contains(result.err, ", V20, B1\n")) << result.err;
}

}  // namespace
}  // namespace carom::test
