// What docs/ says about file formats is what the program says of itself. Where a test here fails, renew the pages with
// tools/renew_formats.py.
#include "commands/describe/formats.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "support/pages.h"

namespace carom::tools {
namespace {

using Json = nlohmann::json;

constexpr const char* kStale = " is stale; run tools/renew_formats.py";

TEST(Formats, TheSchemaOfScenesIsThatOfTheTables) {
    EXPECT_TRUE(test::read_source("docs/reference/scene.schema.json") == scene_schema())
        << "docs/reference/scene.schema.json" << kStale;
}

TEST(Formats, TheSchemaOfRecordsIsThatOfTheTables) {
    EXPECT_TRUE(test::read_source("docs/reference/record.schema.json") == record_schema())
        << "docs/reference/record.schema.json" << kStale;
    EXPECT_EQ(record_schema().find("null\n"), std::string::npos) << "a part of the tables is missing";
}

TEST(Formats, ThePageOfSceneFilesHasTheTables) {
    const std::string page = test::read_source("docs/reference/scene_format.md"), all = scene_format();
    const std::regex block("<!-- begin (\\w+) -->[^]*?<!-- end \\1 -->");
    int blocks = 0;
    for (std::sregex_iterator it(all.begin(), all.end(), block), end; it != end; ++it, ++blocks)
        EXPECT_NE(page.find(it->str()), std::string::npos)
            << "the table " << (*it)[1] << " of docs/reference/scene_format.md" << kStale;
    EXPECT_EQ(blocks, 10);
}

}  // namespace
}  // namespace carom::tools
