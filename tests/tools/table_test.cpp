// Tables of results as text, CSV and JSON.
#include "report/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/sweep_plot.h"

namespace carom::tools {
namespace {

Table sample() {
    Table table(Column("name", "", "<6"), Column("n", "count", ">7"), Column("ns", "time", ">9.2f"),
                Column("same", "same", ">6"), Column("hidden", "", "", false),
                Column("", "only text", ">11"));
    table.add({"a", 3, 1.0 / 3.0, {true, "yes"}, 1.5, "x"});
    table.add({"b", Cell(), INFINITY, false, 2.5, "y"}, "  a note");
    table.add({"c", 5}, "  failed: no end");
    return table;
}

TEST(Table, TextIsAlignedAndHasNotes) {
    EXPECT_EQ(table_text(sample()),
              "        count     time  same  only text\n"
              "a           3     0.33   yes          x\n"
              "b           -      inf     0          y  a note\n"
              "c           5  failed: no end\n");
}

TEST(Table, CsvReadsBackToTheSameBitsWithoutShortRows) {
    EXPECT_EQ(table_csv(sample()),
              "name,n,ns,same\n"
              "a,3,0.3333333333333333,1\n"
              "b,,inf,0\n");
    EXPECT_EQ(csv_line({"a,b", "say \"no\"", "two\nlines", 7, Cell()}),
              "\"a,b\",\"say \"\"no\"\"\",two lines,7,\n");
}

TEST(Table, JsonHasTheExistingCells) {
    const nlohmann::ordered_json rows = nlohmann::ordered_json::parse(table_json(sample()).dump());
    EXPECT_EQ(rows.dump(),
              R"([{"name":"a","n":3,"ns":0.3333333333333333,"same":true,"hidden":1.5},)"
              R"({"name":"b","n":null,"ns":null,"same":false,"hidden":2.5},{"name":"c","n":5}])");
}

TEST(Bins, FollowAGridsStepsOrSpanTheRange) {
    const std::vector<double> grid = {1.0, 1.5, 2.0, 2.5, 1.0};
    const Bins steps = bins_of(grid, 2);
    EXPECT_EQ(steps.count, 4u);
    EXPECT_DOUBLE_EQ(steps.low, 0.75);
    EXPECT_DOUBLE_EQ(steps.high(), 2.75);
    EXPECT_EQ(steps.of(1.0), 0u);
    EXPECT_EQ(steps.of(2.5), 3u);
    std::vector<double> many;
    for (int i = 0; i < 400; ++i) many.push_back(std::pow(i / 399.0, 2));
    const Bins wide = bins_of(many, 1);
    EXPECT_EQ(wide.count, 20u);  // the square root of 400
    EXPECT_EQ(wide.of(0.0), 0u);
    EXPECT_EQ(wide.of(1.0), 19u);
    EXPECT_EQ(wide.of(0.051), 1u);
    EXPECT_EQ(bins_of(std::vector<double>(3, 7.0), 1).count, 1u);
    EXPECT_EQ(bins_of({}, 1).count, 1u);
}

}  // namespace
}  // namespace carom::tools
