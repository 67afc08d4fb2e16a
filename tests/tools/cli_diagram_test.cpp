// carom diagram and plots of sweeps: files that other programs open, and refusals.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "cli.h"

namespace carom::test {
namespace {

class CliDiagram : public ::testing::Test {
  protected:
    void SetUp() override {
        if (contains(carom({"diagram", scene_, "-o", folder_.file("try.svg")}).err, "no diagrams"))
            GTEST_SKIP() << "this build has no cairo";
    }

    std::string draw(const std::string& name, std::vector<std::string> more = {}) {
        std::vector<std::string> arguments = {"diagram", scene_, "-o", folder_.file(name)};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProcessResult result = carom(arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        return read_file(folder_.file(name));
    }

    TemporaryFolder folder_;
    std::string scene_ = folder_.write("shot.toml", kSmallScene);
    const std::string draw_ = CAROM_SOURCE_DIR "/scenes/draw.toml";
};

TEST_F(CliDiagram, WritesTheFormatOfTheFileName) {
    const std::string svg = draw("shot.svg"), pdf = draw("shot.pdf"), png = draw("shot.png");
    EXPECT_TRUE(svg.starts_with("<?xml")) << svg.substr(0, 80);
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
    // Letters are outlines, so that every program shows the same.
    EXPECT_FALSE(contains(svg, "<text"));
    EXPECT_TRUE(pdf.starts_with("%PDF-"));
    EXPECT_TRUE(contains(pdf, "%%EOF"));
    EXPECT_TRUE(png.starts_with("\x89PNG\r\n"));
}

TEST_F(CliDiagram, TheSvgIsXml) {
    draw("shot.svg", {"--title", "a < b & \"c\"", "--diamonds"});
    const ProcessResult parsed = run_process(
        {"python3", "-c", "import sys, xml.dom.minidom as m; m.parse(sys.argv[1])", folder_.file("shot.svg")},
        {});
    EXPECT_EQ(parsed.status, 0) << parsed.err;
}

TEST_F(CliDiagram, BlackAndWhiteUsesOnlyGrays) {
    const std::string svg = draw("shot.svg", {"--bw"});
    std::size_t seen = 0;
    for (std::size_t at = svg.find("rgb("); at != svg.npos; at = svg.find("rgb(", at + 1), ++seen) {
        std::string inside = svg.substr(at + 4, svg.find(')', at) - at - 4);
        std::erase(inside, ' ');  // since cairo 1.18
        const std::string red = inside.substr(0, inside.find(','));
        EXPECT_EQ(inside, red + "," + red + "," + red) << inside;
    }
    EXPECT_GT(seen, 10u);
    EXPECT_NE(svg, draw("color.svg"));
}

// Without colour, unnumbered balls have letters that distinguish white, yellow and red.
TEST_F(CliDiagram, BlackAndWhiteBallsDiffer) {
    const auto drawn = [&](const char* id) {
        folder_.write("one.toml", std::string("[table]\npreset = \"carom\"\n[[ball]]\nid = \"") + id +
                                      "\"\nposition = [0.5, 0.5]\n[[ball]]\nid = \"cue\"\nposition = [1, 1]\n"
                                      "[cue]\nspeed = 0\n");
        EXPECT_EQ(
            carom({"diagram", folder_.file("one.toml"), "--bw", "--title", "t", "-o", folder_.file("o.svg")})
                .status,
            0);
        return read_file(folder_.file("o.svg"));
    };
    EXPECT_NE(drawn("yellow"), drawn("red"));
    EXPECT_NE(drawn("9"), drawn("1"));
}

TEST_F(CliDiagram, DrawsRecordsAndSeveralShotsOnAPage) {
    ASSERT_EQ(carom({"simulate", scene_, "-o", folder_.file("r.json")}).status, 0);
    const std::string one = draw("one.svg"), two = draw("two.svg", {folder_.file("r.json")});
    EXPECT_GT(two.size(), one.size());
}

TEST_F(CliDiagram, ASweepDrawsItsFirstMeasure) {
    const auto sweep = [&](const std::string& plot, std::vector<std::string> more) {
        more.insert(more.begin(),
                    {"sweep", draw_, "-o", folder_.file("p.csv"), "--plot", folder_.file(plot)});
        return carom(more);
    };
    const std::vector<std::string> grid = {"--vary",    "cue.aim_deg=grid(134,136,5)",
                                           "--vary",    "cue.speed=grid(2,3,3)",
                                           "--measure", "\"1\" in pocketed"};
    const ProcessResult map = sweep("map.svg", grid);
    ASSERT_EQ(map.status, 0) << map.err;
    EXPECT_TRUE(contains(map.out, "15 shots")) << map.out;
    const std::string svg = read_file(folder_.file("map.svg"));
    EXPECT_TRUE(svg.starts_with("<?xml")) << svg.substr(0, 80);
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
    ASSERT_EQ(sweep("one.png", {"--vary", "cue.speed=uniform(2,3)", "--count", "50", "--measure", "duration"})
                  .status,
              0);
    EXPECT_TRUE(read_file(folder_.file("one.png")).starts_with("\x89PNG\r\n"));
}

}  // namespace
}  // namespace carom::test
