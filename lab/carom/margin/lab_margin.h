// carom-lab margin: the report of `carom margin` as a plot, a page or a trace, and at every accuracy and
// frame rate.
#pragma once

#include <string>

#include "carom/engine/plan.h"
#include "commands/margin/margin.h"

namespace carom::tools {

struct LabMarginArgs : MarginArgs {
    /// Accuracy x frame rate.
    bool sweep = false;
    /// File names; empty: not written.
    std::string trace, html;
};

/// The frames of one run as Chrome trace events: frame k begins at k / fps, or when the previous one ends, as
/// in a loop that simulates, draws and waits.
std::string margin_trace(const MarginRun& run, double fps);

/// --sweep: every accuracy at every frame rate. Returns the exit status.
int run_margin_sweep(const Plan& plan, const LabMarginArgs& args);

}  // namespace carom::tools
