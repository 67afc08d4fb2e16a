// carom-lab bench shot: whole shots in units of one baseline impact, and the growth of an event's cost with
// the number of balls.
#pragma once

#include <string>
#include <vector>

#include "carom/engine/plan.h"

namespace carom::tools {

struct BenchShotArgs {
    bool json = false;
    int seeds = 9;        ///< of every shot; the row is their median
    int repeats = 15;     ///< interleaved rounds; a shot counts with its minimum over them
    bool growth = true;   ///< gases of 16 to 10000 balls
    long events = 20000;  ///< of a gas, at each size
};

/// One shot. Times are those of simulate(), including set-up and record.
struct ShotRow {
    std::string name;
    double cost_in_impacts = 0.0;  ///< median over the seeds, of time / one baseline impact
    double shots_per_cpu_s = 0.0;  ///< for a batch, whose row is the mean over its shots; 0 for a single shot
    double cost_least = 0.0, cost_most = 0.0;
    double ns_min = 0.0,
           ns_median = 0.0;               ///< of the whole shot: medians over the seeds of minimum and median
    double events = 0.0, clusters = 0.0;  ///< per shot, medians
    double ns_per_event = 0.0;
    /// Time of a profiled run per event [ns]; it includes the six clock readings of each event.
    double detect_ns = 0.0, resolve_ns = 0.0, kernel_ns = 0.0, cluster_ns = 0.0, queue_ns = 0.0;
};

/// One gas, without its set-up.
struct GasRow {
    std::string name;  ///< "gas" (pair by pair) or "gas compliant" (the default model of clusters)
    ClusterModel clusters = ClusterModel::kSequential;
    int balls = 0;
    Search search = Search::kDirect;
    bool chosen = false;                   ///< by the plan
    double ns_min = 0.0, ns_median = 0.0;  ///< per event
    double growth = 0.0;                   ///< ns_min divided by that of the first row with its name
    double bytes_per_ball = 0.0;           ///< on the heap once the run is set up, without scene and plan
};

struct ShotBench {
    std::string cpu, compiler, baseline_isa, isa;
    double baseline_ns = 0.0;
    int seeds = 0, repeats = 0;
    std::vector<ShotRow> rows;
    std::vector<GasRow> growth;
};

ShotBench measure_shots(const BenchShotArgs& options);
std::string shot_bench_json(const ShotBench& bench);
std::string shot_bench_text(const ShotBench& bench);

}  // namespace carom::tools
