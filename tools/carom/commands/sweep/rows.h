// The table that a sweep writes: its header, and one row per shot.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "carom/engine/batch.h"
#include "carom/engine/sweep_columns.h"
#include "carom/engine/variation.h"
#include "carom/kernel/isa.h"

namespace carom::tools {

using Outcomes = std::array<std::uint64_t, kShotStatuses>;

/// The names of sweep_columns(), with a line end.
std::string sweep_header(const Variation& variation);

/// Rows of consecutive shots, with their line ends.
struct SweepRows {
    std::string text;
    Outcomes outcomes{};
};

/// Plays shots first, first + 1, ... and writes their rows. A row depends only on the variation and the
/// number of its shot; invalid and failed shots have a row, too. @throws Interrupted
SweepRows play_rows(const Variation& variation, std::uint64_t first, std::size_t shots, kernel::Isa isa);
/// The same, shared among threads. @throws Interrupted, std::system_error if the system cannot start the
/// threads
SweepRows play_rows(const Variation& variation, std::uint64_t first, std::size_t shots, kernel::Isa isa,
                    int threads);

}  // namespace carom::tools
