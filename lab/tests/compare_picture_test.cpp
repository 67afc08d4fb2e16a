// The picture of two shots with known lines.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/scene.h"
#include "carom/engine/simulate.h"
#include "compare/picture.h"
#include "report/plot.h"

namespace carom::tools {
namespace {

Record played(const std::string& text) {
    return simulate(make_plan(parse_scene(text, "a test"), kernel::Isa::kFastest));
}

/// The named paths in a plot, without the dots at their ends.
std::vector<Series> ways(const Plot& plot, bool dashed) {
    std::vector<Series> found;
    for (const Series& series : plot.series)
        if (series.line && series.dashed == dashed && series.colour != 7) found.push_back(series);
    return found;
}

// Up the table, then right; on paper right, then down.
TEST(WaysPlot, IsTurnedNotMirroredAndToScale) {
    const std::string up = "[[ball]]\nid = \"a\"\nposition = [0.3, 0.4]\nvelocity = [0, 0.4]\n",
                      right = "[[ball]]\nid = \"a\"\nposition = [0.3, 0.4]\nvelocity = [0.4, 0]\n";
    const Record a = played(up), b = played(right);
    const Plot plot = ways_plot(a, "up", b, "right");
    EXPECT_EQ(plot.title, "up and right");
    ASSERT_EQ(ways(plot, false).size(), 1u);
    ASSERT_EQ(ways(plot, true).size(), 1u);
    const Series solid = ways(plot, false)[0], dashed = ways(plot, true)[0];
    EXPECT_EQ(solid.name, "a");
    EXPECT_EQ(dashed.name, "");
    EXPECT_EQ(solid.colour, dashed.colour);
    const double length = a.state_at(0, a.duration).position.y() - 0.4;
    EXPECT_GT(length, 0.1);
    EXPECT_EQ(solid.points.front(), (std::pair{0.4, -0.3}));
    EXPECT_NEAR(solid.points.back().first - 0.4, length, 1e-12);
    EXPECT_NEAR(solid.points.back().second, -0.3, 1e-12);
    EXPECT_NEAR(dashed.points.back().first, 0.4, 1e-12);
    EXPECT_NEAR(dashed.points.back().second, -0.3 - length, 1e-12);
    EXPECT_NEAR(kPlotWidth / (*plot.x.high - *plot.x.low), kPlotHeight / (*plot.y.high - *plot.y.low), 1e-9);
    // The whole table is in the frame, and the marks state x.
    EXPECT_LT(*plot.x.low, 0.0);
    EXPECT_GT(*plot.x.high, 2.54);
    EXPECT_LT(*plot.y.low, -1.27);
    EXPECT_GT(*plot.y.high, 0.0);
    for (const auto& [place, text] : plot.y.marks) EXPECT_EQ(std::stod(text), 0.0 - place) << text;
    EXPECT_GE(plot.y.marks.size(), 3u);
    EXPECT_EQ(plot_svg(plot).find(">-0<"), std::string::npos);
}

TEST(WaysPlot, ColoursDependOnNames) {
    const auto two = [](const char* first, const char* second) {
        return played(std::string("[[ball]]\nid = \"") + first +
                      "\"\nposition = [0.3, 0.4]\n[[ball]]\nid = \"" + second +
                      "\"\nposition = [0.6, 0.4]\n");
    };
    const std::vector<Series> a = ways(ways_plot(two("a", "b"), "", two("b", "a"), ""), false),
                              b = ways(ways_plot(two("a", "b"), "", two("b", "a"), ""), true);
    ASSERT_EQ(a.size(), 2u);
    ASSERT_EQ(b.size(), 2u);
    EXPECT_NE(a[0].colour, a[1].colour);
    EXPECT_EQ(a[0].colour, b[1].colour);
    EXPECT_EQ(a[1].colour, b[0].colour);
    // A ball missing from A is grey, like the cushions.
    EXPECT_EQ(ways(ways_plot(two("a", "b"), "", two("b", "c"), ""), true).size(), 1u);
}

TEST(WaysPlot, AcceptsAnEndlessClothWithOneRestingBall) {
    const Record rest = played("[table]\ncushion = []\n[[ball]]\nid = \"a\"\nposition = [3, 4]\n");
    const std::string svg = plot_svg(ways_plot(rest, "a", rest, "b"));
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
}

}  // namespace
}  // namespace carom::tools
