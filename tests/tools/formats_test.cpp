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

TEST(Formats, TheSchemaOfRecordsHasThePartsOfTheTables) {
    const Json schema = Json::parse(test::read_source("docs/reference/record.schema.json"));
    const Json parts = Json::parse(record_schema());
    EXPECT_GE(parts.size(), 8u);
    for (const auto& [pointer, part] : parts.items())
        EXPECT_TRUE(schema.at(Json::json_pointer(pointer)) == part)
            << pointer << " of docs/reference/record.schema.json" << kStale;
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
