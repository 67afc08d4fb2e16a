// Charts as files. SVG needs no other library; PDF and PNG are drawn by cairo.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/options.h"
#include "page/chart.h"

namespace carom::tools {

/// The frame between the axes [pixels].
inline constexpr double kPlotWidth = 630.0, kPlotHeight = 410.0;

struct Pen {
    const char* colour;
    double width = 1.0;
    const char* dash = "";  ///< lengths on and off: "5 4"
};

struct Font {
    double size = 13.0;
    const char* colour = "#000";
    bool bold = false, halo = false;
    bool upwards = false;  ///< read from below to above
};

/// The paper of a chart. All in pixels; y points down.
class Paper {
  public:
    virtual ~Paper() = default;
    /// @param anchor  "start", "middle" or "end": the part of the text that is at x
    virtual void text(double x, double y, const std::string& words, const char* anchor, const Font& font) = 0;
    virtual void line(double x1, double y1, double x2, double y2, const Pen& pen) = 0;
    virtual void path(const std::vector<std::pair<double, double>>& points, const Pen& pen) = 0;
    virtual void dot(double x, double y, double radius, const char* colour) = 0;
    virtual void frame(double x, double y, double width, double height, const Pen& pen) = 0;
};

/// The size of a chart [pixels].
inline constexpr double kChartWidth = 960.0, kChartHeight = 530.0;

void draw_chart(const Plot& plot, Paper& paper);

/// A chart by cairo. @param format  one of kDiagramFormats  @return the file's bytes  @throws
/// std::runtime_error
std::string cairo_chart(const Plot& plot, const std::string& format);

/// The whole file. Text is escaped; equal plots give equal bytes.
std::string plot_svg(const Plot& plot);

/// In the format of its name, written under a temporary name and renamed. @throws std::runtime_error naming
/// the file
void write_plot(const Plot& plot, const std::string& path);

/// Adds --plot.
void add_plot(Options& command, std::string& plot);

/// Checks the argument of --plot before any work is done; it may be empty. @throws UsageError
void check_plot_path(const std::string& path);

}  // namespace carom::tools
