// No include points upwards; and the check detects one that does.
#include "layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "support/process.h"

namespace carom::test {
namespace {

namespace fs = std::filesystem;

TEST(Layers, NoIncludePointsUpwards) {
    for (const char* layer :
         {"kernel", "engine", "games", "interface", "render", "capi", "tools", "python", "web", "lab"}) {
        ASSERT_TRUE(fs::exists(fs::path(CAROM_SOURCE_DIR) / layer)) << layer;
    }
    for (const std::string& violation : layer_violations(CAROM_SOURCE_DIR)) ADD_FAILURE() << violation;
}

std::vector<std::string> missing(const std::set<std::string>& all, const std::set<std::string>& from) {
    std::vector<std::string> some;
    std::set_difference(all.begin(), all.end(), from.begin(), from.end(), std::back_inserter(some));
    return some;
}

TEST(Layers, TheDesignPageDrawsTheExistingArrows) {
    const std::set<std::string> exist = layer_arrows(CAROM_SOURCE_DIR);
    const std::set<std::string> drawn =
        described_arrows(read_file(CAROM_SOURCE_DIR "/docs/design/architecture.md"));
    ASSERT_GT(exist.size(), 15u);
    for (const std::string& arrow : missing(exist, drawn)) ADD_FAILURE() << "not drawn: " << arrow;
    for (const std::string& arrow : missing(drawn, exist)) ADD_FAILURE() << "drawn, but gone: " << arrow;
}

/// A small tree with all four layers, to which a test adds one line.
class LayersSelfTest : public ::testing::Test {
  protected:
    void SetUp() override {
        put("kernel/include/carom/kernel/k.h", "#include <cmath>\n");
        put("kernel/src/k.cpp",
            "#include \"carom/kernel/k.h\"\n#include <immintrin.h>\n#include \"inner.h\"\n");
        put("kernel/src/inner.h", "#pragma once\n");
        put("kernel/src/march/m.h", "#include \"inner.h\"\n");
        put("kernel/src/tolerance/t.h", "#pragma once\n");
        put("lab/ladder/l.h", "#include \"march/m.h\"\n#include \"inner.h\"\n");
        put("kernel/reference/s.h", "#include \"carom/kernel/k.h\"\n");
        put("engine/src/e.cpp", "#include <Eigen/Core>\n#include \"carom/kernel/k.h\"\n");
        put("engine/src/base/b.h", "#pragma once\n");
        put("engine/src/contact/c.h", "#include \"base/b.h\"\n");
        put("engine/src/scene/s.cpp", "#include \"contact/c.h\"\n#include \"carom/engine/plan.h\"\n");
        put("engine/src/loop/l.h", "#include \"contact/c.h\"\n");
        put("engine/CMakeLists.txt",
            "target_link_libraries(carom_engine PUBLIC carom::kernel) # carom::tools\n");
        put("games/src/g.cpp", "#include \"base/b.h\"\n#include \"carom/engine/e.h\"\n");
        put("render/src/stage/s.cpp", "#include \"base/b.h\"\n");
        put("render/src/draw/d.h", "#pragma once\n");
        put("render/src/r.cpp", "#include <png.h>\n#include <GL/gl.h>\n#include \"carom/engine/e.h\"\n");
        put("tools/t.cpp", "#include <CLI/CLI.hpp>\n#include \"carom/render/r.h\"\n#include \"u.h\"\n");
        put("tools/u.h", "#pragma once\n");
        put("tools/carom/main.cpp", "#include \"base/p.h\"\n#include \"commands/view/v.h\"\n");
        put("tools/carom/base/p.h", "#include \"reference/s.h\"\n#include \"base/b.h\"\n");
        put("tools/carom/page/q.h", "#include \"base/p.h\"\n");
        put("tools/carom/commands/view/v.h", "#include \"base/p.h\"\n#include \"page/q.h\"\n");
        put("tools/carom/commands/margin/m.h", "#include \"base/p.h\"\n");
        put("lab/carom/r.h", "#pragma once\n");
        put("lab/carom/l.cpp",
            "#include \"ladder/l.h\"\n#include \"commands/view/v.h\"\n#include \"contact/c.h\"\n#include "
            "\"r.h\"\n");
        put("lab/measure/m.cpp", "#include \"support/s.h\"\n#include \"contact/c.h\"\n");
        put("capi/src/c.cpp",
            "#include \"carom/carom.h\"\n#include \"c.h\"\n#include \"carom/engine/e.h\"\n");
        put("capi/src/c.h", "#pragma once\n");
        put("python/src/p.cpp",
            "#include <nanobind/nanobind.h>\n#include \"base/b.h\"\n#include \"carom/render/r.h\"\n#include "
            "\"page/q.h\"\n");
        put("tests/support/s.h", "#pragma once\n");
        put("tests/t.cpp", "#include \"support/s.h\"\n#include \"gone_in_the_build.h\"\n");
    }

    void put(const std::string& name, const std::string& text) {
        const fs::path file = folder_.path() / name;
        fs::create_directories(file.parent_path());
        std::ofstream(file, std::ios::app) << text;
    }

    std::vector<std::string> check() const { return layer_violations(folder_.path()); }

    TemporaryFolder folder_;
};

TEST_F(LayersSelfTest, AcceptsDownwardIncludes) {
    for (const std::string& violation : check()) ADD_FAILURE() << violation;
}

// Detects one arrow too many in the tree, and one too few on the page.
TEST_F(LayersSelfTest, ReadsArrowsFromTheTreeAndFromThePage) {
    const std::string page =
        "# A\n\nkernel -> games\n\n## Layers\n\n```\n"
        " 6 lab      lab    -> anything\n"
        " 5 tools    tools  -> render, engine, kernel\n"
        "            python -> tools (page), render, engine\n"
        "            capi   -> engine\n"
        "   games    games  -> engine\n"
        "            render -> engine\n"
        " 2 engine   engine -> kernel\n"
        " 1 kernel   kernel -> the C++ standard library\n```\n\n## Rooms\n\ngames -> render\n";
    EXPECT_EQ(layer_arrows(folder_.path()), described_arrows(page));
    put("games/src/g.cpp", "#include \"carom/kernel/k.h\"\n");
    EXPECT_EQ(missing(layer_arrows(folder_.path()), described_arrows(page)),
              std::vector<std::string>{"games -> kernel"});
    put("python/src/p.cpp", "#include \"carom/carom.h\"\n");
    EXPECT_EQ(missing(layer_arrows(folder_.path()), described_arrows(page)).size(), 2u);
    EXPECT_EQ(missing(described_arrows(page + "\n"), layer_arrows(folder_.path())).size(), 0u);
}

TEST_F(LayersSelfTest, DetectsEveryKindOfViolation) {
    const struct {
        const char* file;
        const char* line;
        const char* message;
    } kCases[] = {
        {"kernel/src/k.cpp", "#include \"carom/engine/e.h\"\n", "upwards to engine"},
        {"kernel/src/k.cpp", "#include <carom/engine/e.h>\n", "upwards to engine"},
        {"kernel/src/k.cpp", "  #  include\t<Eigen/Core>\n", "standard library only"},
        {"kernel/src/k.cpp", "#include <unistd.h>\n", "standard library only"},
        {"engine/src/e.cpp", "#include \"carom/render/r.h\"\n", "upwards to render"},
        {"engine/src/e.cpp", "#include \"../../render/src/r.cpp\"\n", "upwards to render"},
        {"engine/src/e.cpp", "#include \"carom/games/g.h\"\n", "upwards to games"},
        {"games/src/g.cpp", "#include \"carom/render/r.h\"\n", "upwards to render"},
        {"games/src/g.cpp", "#include \"contact/c.h\"\n", "engine/src, which is not public"},
        {"engine/src/e.cpp", "#include<png.h>\n", "not for this layer"},
        {"engine/src/e.cpp", "#include \"support/s.h\"\n", "outside the layers"},
        {"engine/src/e.cpp", "#include \"u.h\"\n", "upwards to tools"},
        {"render/src/r.cpp", "#import \"../../tools/u.h\"\n", "upwards to tools"},
        {"render/src/r.cpp", "#include \"carom/tools/u.h\"\n", "upwards to tools"},
        {"render/src/r.cpp", "#include \"gone.h\"\n", "cannot be resolved"},
        {"capi/src/c.cpp", "#include \"carom/render/r.h\"\n", "upwards to render"},
        {"capi/src/c.cpp", "#include \"../../tools/u.h\"\n", "upwards to tools"},
        {"capi/CMakeLists.txt", "target_link_libraries(carom_c carom::render)\n", "links carom::render"},
        {"render/src/r.cpp", "#include \"carom/carom.h\"\n", "outside the layers"},
        {"python/src/p.cpp", "#include \"contact/c.h\"\n", "engine/src, which is not public"},
        {"tools/carom/base/p.h", "#include \"../../python/src/p.cpp\"\n", "outside the layers"},
        {"render/src/r.cpp", "#include HEADER\n", "not a literal name"},
        {"kernel/src/k.cpp", "#include \"ladder/l.h\"\n", "upwards to lab"},
        {"tools/carom/base/p.h", "#include \"ladder/l.h\"\n", "upwards to lab"},
        {"tools/carom/commands/view/v.h", "#include \"../../../../lab/carom/r.h\"\n", "upwards to lab"},
        {"python/src/p.cpp", "#include \"../../lab/carom/r.h\"\n", "upwards to lab"},
        {"tests/t.cpp", "#include \"ladder/l.h\"\n", "into the laboratory"},
        {"tools/carom/base/p.h", "#include \"page/q.h\"\n", "room on the right"},
        {"tools/carom/page/q.h", "#include \"commands/view/v.h\"\n", "room on the right"},
        {"tools/carom/commands/view/v.h", "#include \"commands/margin/m.h\"\n", "another station"},
        {"tools/carom/CMakeLists.txt", "set(folder ${PROJECT_SOURCE_DIR}/tests/data)\n", "reads tests/"},
        {"tools/carom/CMakeLists.txt", "target_link_libraries(carom_tools carom::ladder)\n",
         "links carom::ladder"},
        {"kernel/src/march/m.h", "#include \"tolerance/t.h\"\n", "another station"},
        {"kernel/src/inner.h", "#include \"march/m.h\"\n", "room on the right"},
        {"engine/src/base/b.h", "#include \"contact/c.h\"\n", "room on the right"},
        {"engine/src/contact/c.h", "#include \"loop/l.h\"\n", "room on the right"},
        {"engine/src/contact/c.h", "#include \"carom/engine/plan.h\"\n", "from a toolbox"},
        {"engine/src/scene/s.cpp", "#include \"loop/l.h\"\n", "another station"},
        {"engine/src/scene/s.cpp", "#include \"../loop/l.h\"\n", "another station"},
        {"engine/src/junk/j.h", "#include \"base/b.h\"\n", "of no known room"},
        {"engine/src/loop/l.h", "#include \"reference/s.h\"\n", "kernel/reference, which is not public"},
        {"render/src/stage/s.cpp", "#include \"draw/d.h\"\n", "another station"},
        {"render/src/stage/s.cpp", "#include \"contact/c.h\"\n", "engine/src, which is not public"},
        {"tools/carom/base/p.h", "#include \"contact/c.h\"\n", "engine/src, which is not public"},
        {"tools/carom/base/p.h", "#include \"support/s.h\"\n", "outside the layers"},
        {"engine/CMakeLists.txt", "target_link_libraries(carom_engine PUBLIC carom::render)\n",
         "links carom::render"},
        {"kernel/CMakeLists.txt", "target_link_libraries(carom_kernel carom_engine)\n", "links carom_engine"},
    };
    for (const auto& c : kCases) {
        const fs::path file = folder_.path() / c.file;
        const bool existed = fs::exists(file);
        const std::string before = existed ? read_file(file.string()) : "";
        put(c.file, c.line);
        const std::vector<std::string> found = check();
        ASSERT_EQ(found.size(), 1u) << c.file << ": " << c.line;
        EXPECT_NE(found[0].find(c.message), std::string::npos) << found[0];
        EXPECT_NE(found[0].find(c.file), std::string::npos) << found[0];
        if (existed)
            std::ofstream(file) << before;
        else
            fs::remove(file);
    }
}

}  // namespace
}  // namespace carom::test
