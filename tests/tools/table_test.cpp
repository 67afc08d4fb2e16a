// Tables of results as text, CSV and JSON.
#include "report/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

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

TEST(Table, CsvReadsBackToTheSameBitsAndLeavesOutRowsThatEndEarly) {
    EXPECT_EQ(table_csv(sample()),
              "name,n,ns,same\n"
              "a,3,0.3333333333333333,1\n"
              "b,,inf,0\n");
    EXPECT_EQ(csv_line({"a,b", "say \"no\"", "two\nlines", 7, Cell()}),
              "\"a,b\",\"say \"\"no\"\"\",two lines,7,\n");
}

TEST(Table, JsonHasWhatIsThere) {
    const nlohmann::ordered_json rows = nlohmann::ordered_json::parse(table_json(sample()).dump());
    EXPECT_EQ(rows.dump(),
              R"([{"name":"a","n":3,"ns":0.3333333333333333,"same":true,"hidden":1.5},)"
              R"({"name":"b","n":null,"ns":null,"same":false,"hidden":2.5},{"name":"c","n":5}])");
}

}  // namespace
}  // namespace carom::tools
