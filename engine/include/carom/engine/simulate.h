// The event loop.
#pragma once

#include <functional>
#include <optional>
#include <stdexcept>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"

namespace carom {

struct SimulateOptions {
    bool profile = false;         ///< time every event (Record::costs); off costs nothing
    std::optional<double> until;  ///< stop time [s], in addition to the scene's own
    /// [s] Of the shot in the caller's clock: kept in Record::start_time, enters no computation
    double start_time = 0.0;
    /// Called with (events so far, simulated time) every so many rounds of the loop, and after a round that
    /// was long by itself (a cluster, a march of many steps, resting contacts): for a progress line, and
    /// to end the run by an exception of one's own. A round is an event or nearly so; of a run with fewer it
    /// is not called at all.
    std::function<void(std::size_t, double)> progress;
    int progress_rounds = 64;
};

/// A run that cannot go on: too many events in one simulated microsecond, or a kernel that failed. what()
/// holds a dump of the state.
class SimulationError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Runs a plan to rest, to its stop time or to its number of events; StopReason has the one other end.
/// @throws SimulationError
Record simulate(const Plan& plan, const SimulateOptions& options = {});

/// Goes on with a run of the same plan that stopped at its number of events or its stop time (which the plan
/// no longer has, or has later). The result has the bits of a run that never stopped. @throws SimulationError
Record resume(const Plan& plan, const Record& so_far, const SimulateOptions& options = {});

}  // namespace carom
