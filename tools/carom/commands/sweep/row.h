// The table that a sweep writes: its header, and a row for each shot.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "carom/engine/batch.h"
#include "carom/engine/variation.h"
#include "carom/kernel/isa.h"

namespace carom::tools {

/// `shot,KEY...,outcome,duration,events,first_contact,contacts,cushions,pocketed,ID.x,ID.y,ID.pocket...,message`, with a line end.
std::string sweep_header(const Variation& variation);

/// Plays shots and writes their rows, one thread at a time. A row depends on the variation and the number of its shot only;
/// invalid values and a failing simulation are outcomes, too.
class SweepPlayer {
  public:
    SweepPlayer(const Variation& variation, kernel::Isa isa);

    /// Appends the row of a shot; results are empty for a shot without any. @throws Interrupted
    ShotStatus append(std::uint64_t index, std::string& rows);

  private:
    void append_results(std::string& rows);

    const Variation& variation_;
    Simulator simulator_;
    SimulateOptions options_;
    std::vector<std::string> values_;
    std::vector<int> fallen_;  // balls in the order in which they fell
};

}  // namespace carom::tools
