// Plots as SVG files, drawn by the program itself: nothing else needs to be installed.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace carom::tools {

struct Axis {
    std::string title;
    bool logarithmic = false;
    std::optional<double> low, high;  ///< default: what the points need
    std::vector<std::pair<double, std::string>>
        marks{};  ///< where, and what is written there; empty: round values
};

/// Points, which may be joined by a line. Values that are not finite are not drawn, and values of 0 and below are not drawn on
/// a logarithmic axis.
struct Series {
    std::string name;  ///< in the legend; empty: not there
    std::vector<std::pair<double, double>> points;
    bool line = true, dots = true, dashed = false;
    int colour = -1;               ///< number in the palette; -1: the next one
    std::vector<double> errors{};  ///< half the height of a bar at each point; empty: no bars
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
    std::vector<std::string> notes;  ///< under the title, one line each
    Axis x, y;
    std::vector<Series> series;
    std::vector<Ticks> ticks;
    std::vector<Level> levels;
};

/// The frame between the axes [pixels].
inline constexpr double kPlotWidth = 630.0, kPlotHeight = 410.0;

/// The whole file. Text is escaped; equal plots give equal bytes.
std::string plot_svg(const Plot& plot);

/// Written under a temporary name and renamed. @throws std::runtime_error naming the file
void write_plot(const Plot& plot, const std::string& path);

/// Checks the argument of --plot before any work is done; it may be empty. @throws UsageError
void check_plot_path(const std::string& path);

}  // namespace carom::tools
