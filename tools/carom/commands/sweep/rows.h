// The table that a sweep writes: its header, and one row per shot.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "carom/engine/batch.h"
#include "carom/games/sweep.h"
#include "carom/kernel/isa.h"

namespace carom::tools {

using Outcomes = std::array<std::uint64_t, kShotStatuses>;

/// Consecutive shots, the arrays of their outcomes, and their rows, with line ends; invalid and failed shots
/// also have a row.
struct SweepBlock {
    Batch batch;
    games::SweptShots shots;
    std::vector<std::string> rows;
};

/// Plays shots first, first + 1, ..., while it holds `playing`. @throws Interrupted; std::system_error if the
/// system cannot start the threads; UsageError for a measure that does not apply to such shots
SweepBlock play_block(const games::Sweep& sweep, std::uint64_t first, std::size_t count, kernel::Isa isa,
                      int threads, std::mutex& playing);

/// The names of the columns, with a line end.
std::string sweep_header(const games::Sweep& sweep);

}  // namespace carom::tools
