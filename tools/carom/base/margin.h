// What every frame costs, stage by stage.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/frame_costs.h"
#include "carom/engine/plan.h"
#include "carom/engine/record.h"

namespace carom::tools {

/// How the frames of a margin are drawn.
struct FrameSettings {
    /// Default: that of the scene.
    std::optional<FrameSize> size;
    std::string gl = "auto";
};

/// What is measured of a frame. simulate is the sum of the four behind it; a frame costs simulate and the
/// five after kCluster.
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

/// One run: costs of every frame in ms, one list per stage; without rendering those from kDraw on are empty.
struct MarginRun {
    Record record;
    std::vector<FrameCost> frames;
    std::vector<double> stage[kMarginStages];
    // Wall time of the same work, which is done one frame after the other [ms].
    double simulate_wall_ms = 0.0;
    /// By frame: the share of its picture that was encoded anew; empty if nothing was drawn.
    std::vector<double> encoded_share;
    /// Of drawing to writing [ms], for every frame except the first.
    std::vector<double> frame_walls;
    double total(std::size_t frame) const;
};
/// Appends what simulating one frame cost.
void add_simulation(MarginRun& run, const FrameCost& frame);
/// Simulates once, with the clock on. @param drawn  how the frames are drawn; null: they are not
MarginRun one_run(const Plan& plan, const FrameSettings* drawn, double fps, const std::string& title);

/// Compares the sum of the parts with the wall time, over
/// all frames except the first, whose start is not known.
struct Accounting {
    double wall_ms = 0.0, parts_ms = 0.0;
    double share() const { return wall_ms > 0.0 ? parts_ms / wall_ms : 1.0; }
};
Accounting account(const MarginRun& run);

struct Spread {
    double p50 = 0.0, p95 = 0.0, p99 = 0.0, max = 0.0;
};
Spread spread(std::vector<double> values);  ///< not empty

/// Smallest and largest of the runs.
struct Range {
    double low = 0.0, high = 0.0;
};

/// What the measurement itself costs: runs with and without it, in alternation.
struct TimingCost {
    double clock_ns = 0.0;                     ///< of reading the clock once
    double plain_ms = 0.0, profiled_ms = 0.0;  ///< the whole simulation, minima
    double share() const { return profiled_ms / plain_ms - 1.0; }
};
TimingCost cost_of_timing(const Plan& plan);

/// All runs together: every frame with its median over them.
struct Margin {
    double fps = 60.0, budget_ms = 0.0;
    FrameSize size{};
    bool rendered = true;
    std::vector<double> stage[kMarginStages];
    std::vector<double> total;
    std::vector<double> encoded_share;  ///< as of a run
    long missed = 0;
    long missed_shown = 0;  ///< if only simulate, draw and readback counted, and no file were written
    std::size_t worst = 0;
    Range p50_runs, p99_runs, missed_runs;  ///< over the runs
    double frame_spread = 0.0;              ///< median over the frames of (max - min) / median over the runs
    int runs = 0;
    Accounting accounting;  ///< of all runs
    TimingCost timing;

    bool has(std::size_t s) const { return rendered || s <= kCluster; }
    /// The part of the budget that is left [%]; negative for a frame that was missed.
    double slack(std::size_t frame) const { return 100.0 * (1.0 - total[frame] / budget_ms); }
};
Margin combine(const std::vector<MarginRun>& runs, double fps, bool rendered);

}  // namespace carom::tools
