// The table that a sweep writes: its header, and one row per shot.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/batch.h"
#include "carom/engine/sweep_columns.h"
#include "carom/engine/variation.h"
#include "carom/games/measures.h"
#include "carom/kernel/isa.h"
#include "report/sweep_plot.h"

namespace carom::tools {

using Outcomes = std::array<std::uint64_t, kShotStatuses>;

/// What makes the rows: the shots, and the measures whose columns follow those of sweep_columns().
struct Sweep {
    const Variation& variation;
    const std::vector<games::Measure>& measures;
    kernel::Isa isa;
    int threads;
    /// A shot for the plot: the first measure, over these keys if there are two.
    bool plot = false;
    std::vector<std::size_t> plot_keys{};
};

/// The names of the columns, with a line end.
std::string sweep_header(const Sweep& sweep);

/// Rows of consecutive shots, with their line ends.
struct SweepRows {
    std::string text;
    Outcomes outcomes{};
    /// For each shot with a result, the values of all measures.
    std::vector<games::MeasureValue> values;
    std::vector<PlotShot> plotted;  ///< the same shots, if there is a plot
};

/// Plays shots first, first + 1, ... on several threads, and writes their rows. A row depends only on the
/// variation and the number of its shot; invalid and failed shots have a row, too.
/// @throws Interrupted; std::system_error if the system cannot start the threads; UsageError for a measure
/// that does not apply to such shots
SweepRows play_rows(const Sweep& sweep, std::uint64_t first, std::size_t shots);

/// What the plot shows of rows that were written before.
std::vector<PlotShot> plotted_rows(const Sweep& sweep, std::string_view rows);

}  // namespace carom::tools
