// Charts, described once: a page draws them (chart.js), and the laboratory draws them as SVG files.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace carom::tools {

struct Axis {
    std::string title;
    bool logarithmic = false;
    /// Default: the range of the points.
    std::optional<double> low, high;
    /// Positions and texts of the marks; empty: round values.
    std::vector<std::pair<double, std::string>> marks{};
};

/// Points, which may be joined by a line. Values that are not finite are skipped, as are values of 0 and
/// below on a logarithmic axis.
struct Series {
    /// In the legend; empty: no entry.
    std::string name;
    std::vector<std::pair<double, double>> points;
    bool line = true, dots = true, dashed = false;
    /// Number in the palette; -1: the next one.
    int colour = -1;
    /// Half the height of a bar at each point; empty: no bars.
    std::vector<double> errors{};
};

/// A short stroke on the x axis for each value: events of one kind.
struct Ticks {
    std::string name;
    std::vector<double> at;
};

/// A dashed line across the plot.
struct Level {
    std::string name;
    double y = 0.0;
};

struct Plot {
    std::string title;
    /// Under the title, one line each.
    std::vector<std::string> notes;
    Axis x, y;
    std::vector<Series> series;
    std::vector<Ticks> ticks;
    std::vector<Level> levels;
};

/// The chart as chart.js reads it. Values have five significant digits, far below a pixel.
/// @param by_point the reader looks at single points, not at all series at one x
nlohmann::ordered_json chart_json(const Plot& plot, bool by_point = false);

}  // namespace carom::tools
