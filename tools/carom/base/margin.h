// The cost of every frame, stage by stage.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"

namespace carom::tools {

/// The frame k in 0..frames-1 with t_k <= t < t_(k+1), t_k being render::frame_time: an
/// event at a frame's own time belongs to that frame only. An event before the first
/// frame belongs to the first one, an event after the last frame to the last one.
long frame_of(double t, double from, double fps, long frames);

/// The cost of the simulation during one frame [ms].
struct FrameCost {
    double detect_ms = 0.0;           ///< finding its events, and searching again after each
    double resolve_ms = 0.0;          ///< advancing and resolving, without the next two
    double kernel_ms = 0.0;           ///< inside the kernel of ball-ball impacts
    double cluster_ms = 0.0;          ///< inside the map of impacts of three balls and more
    std::vector<std::size_t> events;  ///< indices into Record::events
    double simulate_ms() const { return detect_ms + resolve_ms + kernel_ms + cluster_ms; }
};

/// Sums the costs of a profiled record by frame. The first search of all pairs, before any event, belongs to
/// frame 0. The sums over all frames equal the sums over all events.
std::vector<FrameCost> costs_by_frame(const Record& record, double from, double fps, long frames);

/// Percentile by nearest rank: the smallest value such that at least p percent of all values do not exceed
/// it.
/// @param sorted ascending, not empty @param p 0..100
double percentile(const std::vector<double>& sorted, double p);

/// Settings for drawing the frames of a margin.
struct FrameSettings {
    /// Default: the scene's.
    std::optional<FrameSize> size;
    std::string gl = "auto";
};

/// The stages of a frame. kSimulate is the sum of the next four; a frame costs kSimulate plus the four after
/// kCluster.
enum MarginStage : std::size_t {
    kSimulate,
    kDetect,
    kResolve,
    kKernel,
    kCluster,
    kDraw,
    kReadback,
    kEncode,
    kWrite,
    kMarginStages
};
const char* name(MarginStage stage);
bool is_part_of_simulate(std::size_t stage);

/// One run: the cost of every frame [ms], one list per stage. Without rendering, the lists from kDraw on are
/// empty.
struct MarginRun {
    Record record;
    std::vector<FrameCost> frames;
    std::vector<double> stage[kMarginStages];
    /// Wall time from the end of the simulation to the first picture [ms]: OpenGL, the table.
    double setup_ms = 0.0;
    /// Per frame: the share of the picture that was encoded anew; empty if nothing was drawn.
    std::vector<double> encoded_share;
    double total(std::size_t frame) const;
};
/// Appends the cost of simulating one frame.
void add_simulation(MarginRun& run, const FrameCost& frame);
/// Simulates once with timing on. @param drawn how to draw the frames; null: not drawn
MarginRun one_run(const Plan& plan, const FrameSettings* drawn, double fps, const std::string& title);

/// The wall time of the process and its parts [ms], over all runs.
struct Accounting {
    double start_ms = 0.0;  ///< until the first run: the program, the scene, its plan
    double setup_ms = 0.0, first_frames_ms = 0.0, frames_ms = 0.0;
    double timing_ms = 0.0;  ///< to measure the cost of timing
    double wall_ms = 0.0;
    double parts_ms() const { return start_ms + setup_ms + first_frames_ms + frames_ms + timing_ms; }
    double share() const { return wall_ms > 0.0 ? parts_ms() / wall_ms : 1.0; }
};
/// Adds a run, whose frame 0 stays apart.
void account(const MarginRun& run, Accounting& sum);
/// Wall time since the process began [ms].
double process_ms();

struct Spread {
    double p50 = 0.0, p95 = 0.0, p99 = 0.0, max = 0.0;
};
Spread spread(std::vector<double> values);  ///< not empty

/// Smallest and largest of the runs.
struct Range {
    double low = 0.0, high = 0.0;
};

/// Frames of one run, or of several: a range over the runs.
struct RunTotals {
    Range p50, p99, max, missed, setup_ms, frame_0_ms;
};

/// The cost of the measurement itself, from alternating runs with and without it.
struct TimingCost {
    double clock_ns = 0.0;                     ///< one reading of the clock
    double plain_ms = 0.0, profiled_ms = 0.0;  ///< the whole simulation; minimum over the runs
    double share() const { return profiled_ms / plain_ms - 1.0; }
};
TimingCost cost_of_timing(const Plan& plan);

/// All runs combined: each frame has its median over the runs.
struct Margin {
    double fps = 60.0, budget_ms = 0.0;
    FrameSize size{};
    bool rendered = true;
    std::vector<double> stage[kMarginStages];
    std::vector<double> total;
    std::vector<double> encoded_share;  ///< as in MarginRun
    long missed = 0;
    long missed_shown = 0;  ///< if only simulate, draw and readback counted, and no file were written
    std::size_t worst = 0;
    RunTotals first, warm, all;  ///< the first run, the others (if there are any), and all of them
    std::size_t quiet = 0;       ///< frames without an event
    double frame_spread = 0.0;   ///< median over the frames of (max - min) / median over the runs
    int runs = 0;
    Accounting accounting;
    TimingCost timing;

    bool has(std::size_t s) const { return rendered || s <= kCluster; }
    double time(std::size_t frame) const;  ///< [s] since the start of the shot
    /// The share of the budget that is left [%]; negative for a missed frame.
    double slack(std::size_t frame) const { return 100.0 * (1.0 - total[frame] / budget_ms); }
};
Margin combine(const std::vector<MarginRun>& runs, double fps, bool rendered);

}  // namespace carom::tools
