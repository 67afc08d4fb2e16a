// The progress of a sweep, in a file for other programs to read while it runs.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "commands/sweep/rows.h"

namespace carom::tools {

/// A JSON object in a file that is replaced as a whole, so that a reader always finds a complete one. Its
/// keys are those of docs/guide/clusters.md.
class SweepStatus {
  public:
    /// @param path empty: nothing is written
    /// @param first, last, from shots first to last - 1 are requested, and those before `from` already exist
    SweepStatus(std::string path, std::string output, std::uint64_t first, std::uint64_t last,
                std::uint64_t from);

    /// Writes the file if a second has passed since the last time. @throws std::runtime_error
    void show(std::uint64_t done, const Outcomes& outcomes);
    /// Writes it for the last time. @param state  "done" or "stopped"
    void end(const char* state);

  private:
    using Clock = std::chrono::steady_clock;
    void write(const char* state);

    std::string path_, output_;
    std::uint64_t first_, last_, from_, done_;
    Outcomes outcomes_{};
    Clock::time_point start_, written_;
};

}  // namespace carom::tools
