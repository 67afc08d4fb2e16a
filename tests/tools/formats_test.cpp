// docs/ describes file formats as the program does. If a test fails here, renew the pages with
// tools/renew_formats.py.
#include "commands/describe/formats.h"

#include <gtest/gtest.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "carom/interface/shape.h"
#include "support/pages.h"

namespace carom::tools {
namespace {

using Json = nlohmann::json;

constexpr const char* kStale = " is stale; run tools/renew_formats.py";

TEST(Formats, TheSchemaOfScenesMatchesTheTables) {
    EXPECT_TRUE(test::read_source("docs/reference/scene.schema.json") == scene_schema())
        << "docs/reference/scene.schema.json" << kStale;
}

TEST(Formats, TheSchemaOfRecordsMatchesTheTables) {
    EXPECT_TRUE(test::read_source("docs/reference/record.schema.json") == record_schema())
        << "docs/reference/record.schema.json" << kStale;
    EXPECT_EQ(record_schema().find("null\n"), std::string::npos) << "a part of the tables is missing";
}

TEST(Formats, ThePageOfSceneFilesMatchesTheProgram) {
    const std::string printed = scene_format();
    EXPECT_TRUE(test::read_source("docs/reference/scene_format.md") == printed)
        << "docs/reference/scene_format.md" << kStale;
    const std::regex block("<!-- begin (\\w+) -->\n\\|[^]*?\\|\n<!-- end \\1 -->");
    const auto blocks = std::distance(std::sregex_iterator(printed.begin(), printed.end(), block), {});
    EXPECT_EQ(blocks, 11);
    EXPECT_EQ(printed.rfind("# Scene format\n", 0), 0u);
}

TEST(Formats, TheTypesOfTheInterfaceMatchTheirRows) {
    EXPECT_TRUE(test::read_source("docs/reference/types.md") == interface::types_page())
        << "docs/reference/types.md" << kStale;
    const std::string sources = test::read_source("python/carom/_types.py") +
                                test::read_source("python/carom/_simulate.py") +
                                test::read_source("web/npm/index.d.ts"),
                      printed = interface::types_for_python() + interface::types_for_typescript();
    const std::regex block(" *(#|//) begin (\\w+)\n[^]*?\n *\\1 end \\2\n");
    std::size_t blocks = 0;
    for (std::sregex_iterator it(printed.begin(), printed.end(), block), end; it != end; ++it, ++blocks)
        EXPECT_NE(sources.find(it->str()), sources.npos) << (*it)[2] << kStale;
    EXPECT_EQ(blocks, interface::types().size() + 6);
}

}  // namespace
}  // namespace carom::tools
