// The table that a sweep writes: its header, and one row per shot.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "carom/engine/batch.h"
#include "carom/engine/sweep_columns.h"
#include "carom/engine/variation.h"
#include "carom/games/measures.h"
#include "carom/kernel/isa.h"

namespace carom::tools {

using Outcomes = std::array<std::uint64_t, kShotStatuses>;

/// What makes the rows: the shots, and the measures whose columns stand behind those of sweep_columns().
struct Sweep {
    const Variation& variation;
    const std::vector<games::Measure>& measures;
    kernel::Isa isa;
    int threads;
};

/// The names of the columns, with a line end.
std::string sweep_header(const Sweep& sweep);

/// Rows of consecutive shots, with their line ends.
struct SweepRows {
    std::string text;
    Outcomes outcomes{};
    /// For each shot with a result the values of all measures.
    std::vector<games::MeasureValue> values;
};

/// Plays shots first, first + 1, ... shared out among threads, and writes their rows. A row depends on the
/// variation and the number of its shot only; a shot with invalid values and one that fails have a row, too.
/// @throws Interrupted; std::system_error where the system gives no threads; UsageError for a measure that
/// cannot be taken of such shots
SweepRows play_rows(const Sweep& sweep, std::uint64_t first, std::size_t shots);

}  // namespace carom::tools
