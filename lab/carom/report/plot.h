// Charts as SVG files, drawn by carom-lab itself: nothing else needs to be installed.
#pragma once

#include <string>

#include "base/options.h"
#include "page/chart.h"

namespace carom::tools {

/// The frame between the axes [pixels].
inline constexpr double kPlotWidth = 630.0, kPlotHeight = 410.0;

/// The whole file. Text is escaped; equal plots give equal bytes.
std::string plot_svg(const Plot& plot);

/// Written under a temporary name and renamed. @throws std::runtime_error naming the file
void write_plot(const Plot& plot, const std::string& path);

/// Adds --plot.
void add_plot(Options& command, std::string& plot);

/// Checks the argument of --plot before any work is done; it may be empty. @throws UsageError
void check_plot_path(const std::string& path);

}  // namespace carom::tools
