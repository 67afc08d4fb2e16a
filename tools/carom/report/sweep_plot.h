// A measure of a sweep, or the success of a search, as a picture: a histogram, or a map over two of the
// values that vary.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "report/diagram.h"

namespace carom::tools {

struct PlotShot {
    std::array<double, 2> place;  ///< the values that vary, of a map
    double value;                 ///< of the measure; left out unless it is finite
};

struct SweepPlot {
    std::string heading, measure;   ///< "Mean of", and an expression
    std::vector<std::string> axes;  ///< two for a map, none for a histogram
    std::vector<PlotShot> shots;
};

/// A division of values into bins of equal width, from `low`.
struct Bins {
    double low = 0.0, width = 1.0;
    std::size_t count = 1;
    /// The bin of a value; the last one includes its upper end.
    std::size_t of(double value) const;
    double high() const { return low + width * static_cast<double>(count); }
};
/// A bin for each value if these are few and evenly spaced, as in a grid; otherwise bins between the smallest
/// and the largest, more of them for more values. @param dimensions 1 for a histogram, 2 for a map
Bins bins_of(std::span<const double> values, int dimensions);

/// @param format  as for draw_diagram  @param shots  drawn to its left  @return the file's bytes
/// @throws std::runtime_error
std::string draw_plot(const SweepPlot& plot, const std::string& format,
                      const std::vector<DiagramShot>& shots = {}, const DiagramStyle& style = {});

}  // namespace carom::tools
