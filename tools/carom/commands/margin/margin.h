// carom margin: the cost of every frame against 1/fps, stage by stage.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/margin.h"
#include "base/options.h"
#include "report/table.h"

namespace carom::tools {

struct MarginArgs {
    std::string scene;
    std::optional<double> fps;
    std::string size;
    int repeat = 3;
    bool no_render = false;
    FrameSettings drawn;
    /// File names; empty: not written.
    std::string csv, plot;
    bool json = false;

    const FrameSettings* drawing() const { return no_render ? nullptr : &drawn; }
};

/// The options that the program and the laboratory share. read_margin_args() reads the options that the
/// parser leaves as text.
void add_margin_options(Options& command, MarginArgs& args);
void read_margin_args(MarginArgs& args);

/// All runs combined, and the cost of timing itself.
struct MeasuredMargin {
    Margin margin;
    MarginRun last;
};
MeasuredMargin measure_margin(const Plan& plan, const MarginArgs& args);

/// "240 frames of 16.667 ms (60 fps, 1280x720), 0 missed"
std::string margin_lead(const Margin& margin);
/// The lines below the table.
std::string margin_sentences(const Margin& margin, const MarginRun& last);
/// Percentiles of every stage that was measured, and of whole frames [ms].
Table stages_table(const Margin& margin);
/// One row per frame.
Table frames_table(const Margin& margin, const MarginRun& last);

/// An event of a profiled record, and its cost [ns].
nlohmann::ordered_json event_cost_json(const Record& record, std::size_t event);

std::string margin_json(const Margin& margin, const MarginRun& last);
std::string margin_text(const Margin& margin, const MarginRun& last, const std::string& scene);

}  // namespace carom::tools
