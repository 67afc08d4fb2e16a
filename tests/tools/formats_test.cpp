// What docs/ says about file formats is what the program says of itself. Where a test here fails, renew the pages with
// tools/renew_formats.py.
#include "commands/describe/formats.h"

#include <gtest/gtest.h>

#include <iterator>
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

TEST(Formats, TheSchemaOfRecordsIsWhatTheProgramPrints) {
    const std::string printed = record_schema();
    EXPECT_TRUE(test::read_source("docs/reference/record.schema.json") == printed)
        << "docs/reference/record.schema.json" << kStale;
    // Not fragments: every part that another one refers to is there.
    const Json schema = Json::parse(printed);
    const std::regex reference("\"#(/definitions/[a-z]+)\"");
    int references = 0;
    for (std::sregex_iterator it(printed.begin(), printed.end(), reference), end; it != end;
         ++it, ++references)
        EXPECT_TRUE(schema.contains(Json::json_pointer(it->str(1)))) << it->str();
    EXPECT_GE(references, 6);
}

TEST(Formats, ThePageOfSceneFilesIsWhatTheProgramPrints) {
    const std::string printed = scene_format();
    EXPECT_TRUE(test::read_source("docs/reference/scene_format.md") == printed)
        << "docs/reference/scene_format.md" << kStale;
    const std::regex block("<!-- begin (\\w+) -->\n\\|[^]*?\\|\n<!-- end \\1 -->");
    const auto blocks = std::distance(std::sregex_iterator(printed.begin(), printed.end(), block), {});
    EXPECT_EQ(blocks, 10);
    EXPECT_EQ(printed.rfind("# Scene format\n", 0), 0u);
}

}  // namespace
}  // namespace carom::tools
