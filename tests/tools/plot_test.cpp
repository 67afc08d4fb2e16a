// Plots are well-formed and reproducible byte for byte, and contain no NaN.
#include "report/plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/console.h"

namespace carom::tools {
namespace {

int count(const std::string& text, const std::string& part) {
    int n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}

Plot example() {
    Plot plot;
    plot.title = "a < b & \"c\"";
    plot.x = {"x", true, {}, {}};
    plot.y = {"y", true, {}, {}};
    plot.series = {{"first", {{1.0, 1e-3}, {10.0, 1e-6}, {100.0, 1e-9}}}};
    return plot;
}

TEST(Plot, IsWellFormedAndRepeatable) {
    const std::string svg = plot_svg(example());
    EXPECT_EQ(svg, plot_svg(example()));
    EXPECT_EQ(svg.substr(0, 4), "<svg");
    EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
    EXPECT_NE(svg.find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
    EXPECT_EQ(count(svg, "<text"), count(svg, "</text>"));
    EXPECT_EQ(count(svg, "<circle"), 3 + 1);  // and one in the legend
    EXPECT_EQ(count(svg, "<polyline"), 1);
}

TEST(Plot, ALogarithmicAxisIsStraightInDecades) {
    const std::string svg = plot_svg(example());
    // Three points a decade apart: equal steps in x.
    std::vector<double> x;
    for (std::size_t at = svg.find("cx=\""); at != std::string::npos; at = svg.find("cx=\"", at + 1))
        x.push_back(std::stod(svg.substr(at + 4)));
    ASSERT_GE(x.size(), 3u);
    EXPECT_NEAR(x[1] - x[0], x[2] - x[1], 0.11);
    EXPECT_GT(x[1], x[0]);
}

TEST(Plot, OmitsUndrawableValues) {
    Plot plot = example();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    plot.series[0].points.insert(plot.series[0].points.end(),
                                 {{nan, 1.0}, {1.0, INFINITY}, {0.0, 1.0}, {-3.0, 1.0}, {1.0, 0.0}});
    plot.ticks = {{"ticks", {nan, 5.0}}};
    plot.levels = {{"level", nan}};
    const std::string svg = plot_svg(plot);
    EXPECT_EQ(count(svg, "<circle"), 3 + 1);
    EXPECT_EQ(count(svg, "nan"), 0);
    EXPECT_EQ(count(svg, "inf"), 0);
}

TEST(Plot, BarsAndCustomMarks) {
    Plot plot;
    plot.x.marks = {{1.0, "first"}, {2.0, "second"}};
    plot.series = {{"bars", {{1.0, 5.0}, {2.0, 6.0}, {3.0, 7.0}}, false}};
    plot.series[0].errors = {0.5, 1.0, INFINITY};
    const std::string svg = plot_svg(plot);
    for (const char* mark : {">first<", ">second<"}) EXPECT_EQ(count(svg, mark), 1) << mark;
    EXPECT_EQ(count(svg, ">1.5<"), 0);
    EXPECT_EQ(count(svg, "stroke=\"#0072b2\""), 2) << "a bar without a finite end is not drawn";
}

TEST(Plot, EmptyAndSinglePointPlotsAreFine) {
    for (const bool logarithmic : {false, true}) {
        Plot plot;
        plot.x.logarithmic = plot.y.logarithmic = logarithmic;
        EXPECT_EQ(count(plot_svg(plot), "nan"), 0);
        plot.series = {{"one", {{2.0, 2.0}}}};
        const std::string svg = plot_svg(plot);
        EXPECT_EQ(count(svg, "nan"), 0);
        EXPECT_EQ(count(svg, "<circle"), 2);
    }
}

TEST(Plot, TheNameMustImplyTheFormat) {
    EXPECT_NO_THROW(check_plot_path(""));
    EXPECT_NO_THROW(check_plot_path("a/b.svg"));
    EXPECT_THROW(check_plot_path("a.jpg"), UsageError);
    EXPECT_THROW(check_plot_path(".svg"), UsageError);
}

}  // namespace
}  // namespace carom::tools
