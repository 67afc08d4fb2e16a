#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "report/sweep_plot.h"

namespace carom::tools {
namespace {

// [-] Grids of at most this many steps have a bin for each.
constexpr std::size_t kMostSteps = 60;
// [-] Fewest and most bins of an axis.
constexpr double kFewest = 4.0, kMost = 40.0;
// [-] Largest difference of the steps of a grid, as a fraction of a step.
constexpr double kUneven = 1e-6;

}  // namespace

std::size_t Bins::of(double value) const {
    const double at = std::floor((value - low) / width);
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(count - 1)));
}

Bins bins_of(std::span<const double> values, int dimensions) {
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    if (sorted.empty()) return {};
    const double low = sorted.front(), high = sorted.back(), shots = static_cast<double>(sorted.size());
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    if (sorted.size() == 1) return {low - 0.5, 1.0, 1};
    const std::size_t steps = sorted.size() - 1;
    const double step = (high - low) / static_cast<double>(steps);
    bool even = sorted.size() <= kMostSteps;
    for (std::size_t i = 0; even && i <= steps; ++i)
        even = std::abs(sorted[i] - low - step * static_cast<double>(i)) <= kUneven * step;
    if (even) return {low - 0.5 * step, step, sorted.size()};
    const double wanted = dimensions == 1 ? std::sqrt(shots) : std::sqrt(shots / 10.0);
    const double count = std::round(std::clamp(wanted, kFewest, kMost));
    return {low, (high - low) / count, static_cast<std::size_t>(count)};
}

}  // namespace carom::tools
