// carom-lab bench shot: the measurement.
#include "bench/shot.h"

#include <malloc.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

#include "base/clock.h"
#include "base/console.h"
#include "base/machine.h"
#include "base/options.h"
#include "base/setup.h"
#include "bench/five_states.h"
#include "bench/many_shots.h"
#include "bench/shot_cases.h"
#include "carom/engine/simulate.h"
#include "carom/kernel/march.h"

namespace carom::tools {
namespace {

/// The unit of all costs [ns]: one impact of the published march at N = 1000, averaged over the paper's five
/// states.
double baseline_impact(kernel::Isa isa) {
    const kernel::MarchFunction march = kernel::march_function(isa);
    kernel::ImpactResult result;
    const double start = thread_ns();
    for (const BenchImpact& s : kFiveStates) march(s.ball1, s.ball2, s.params, 1000, result);
    return (thread_ns() - start) / std::size(kFiveStates);
}

/// One shot of one seed.
struct TimedShot {
    Plan plan;
    std::vector<double> ns{};  ///< one entry per round
    double least_profiled = 1e300;
    std::size_t events = 0;
    std::array<double, 5> split{};  ///< detect, resolve, kernel, cluster, queue [ns of the whole run]

    double time() {
        const double start = thread_ns();
        const Record record = simulate(plan);
        const double all = thread_ns() - start;
        events = record.events.size();
        return all;
    }
    void profile() {
        SimulateOptions options;
        options.profile = true;
        const Record record = simulate(plan, options);
        std::array<double, 5> sum{};
        for (std::size_t i = 0; i < record.costs.size(); ++i) {
            const EventCost& c = record.costs[i];
            sum[0] += c.detect_ns - c.queue_ns;
            sum[1] += c.resolve_ns - c.kernel_ns;
            sum[record.events[i].type == EventType::kBallCluster ? 3 : 2] += c.kernel_ns;
            sum[4] += c.queue_ns;
        }
        sum[0] += record.setup_detect_ns;
        const double all = std::accumulate(sum.begin(), sum.end(), 0.0);
        if (all >= least_profiled) return;
        least_profiled = all;
        split = sum;
    }
};

ShotRow row_of(const std::string& name, const TimedShot* first, int seeds, double baseline_ns) {
    std::vector<double> cost, least, middle, events, clusters;
    ShotRow row;
    row.name = name;
    double all_events = 0.0, all_ns = 0.0;
    std::array<double, 5> split{};
    for (const TimedShot* s = first; s != first + seeds; ++s) {
        cost.push_back(minimum(s->ns) / baseline_ns);
        least.push_back(minimum(s->ns));
        middle.push_back(median(s->ns));
        events.push_back(static_cast<double>(s->events));
        clusters.push_back(static_cast<double>(simulate(s->plan).clusters.size()));
        all_events += events.back();
        all_ns += least.back();
        for (std::size_t k = 0; k < split.size(); ++k) split[k] += s->split[k];
    }
    row.cost_in_impacts = median(cost);
    row.cost_least = minimum(cost);
    row.cost_most = *std::max_element(cost.begin(), cost.end());
    row.ns_min = median(least);
    row.ns_median = median(middle);
    row.events = median(events);
    row.clusters = median(clusters);
    row.ns_per_event = all_ns / all_events;
    double* const parts[] = {&row.detect_ns, &row.resolve_ns, &row.kernel_ns, &row.cluster_ns, &row.queue_ns};
    for (std::size_t k = 0; k < split.size(); ++k) *parts[k] = split[k] / all_events;
    return row;
}

/// A gas with one kind of search.
struct Gas {
    GasRow row;
    Plan plan;

    double time() {
        double begin = 0.0, bytes = 0.0;
        std::size_t first = 0;
        const double before = heap_bytes();
        SimulateOptions options;
        // The first call follows the first event, after the set-up and its allocations.
        options.progress_rounds = 1;
        options.progress = [&](std::size_t events, double) {
            if (begin != 0.0) return;
            bytes = heap_bytes() - before;
            first = events;
            begin = thread_ns();
        };
        const Record record = simulate(plan, options);
        const double all = thread_ns() - begin;
        row.bytes_per_ball = bytes / row.balls;
        return all / static_cast<double>(record.events.size() - first);
    }
    static double heap_bytes() {
        const struct mallinfo2 info = mallinfo2();
        return static_cast<double>(info.uordblks + info.hblkhd);
    }
};

/// A shot of a batch, averaged over a round; the row has the minimum and maximum over the rounds.
ShotRow row_of(const ManyShots& many, const std::string& name, const std::vector<double>& ns,
               double baseline_ns) {
    ShotRow row;
    row.name = name;
    row.ns_min = minimum(ns);
    row.ns_median = median(ns);
    row.cost_in_impacts = row.cost_least = row.ns_min / baseline_ns;
    row.cost_most = *std::max_element(ns.begin(), ns.end()) / baseline_ns;
    row.shots_per_cpu_s = 1e9 / row.ns_min;
    row.events = many.events();
    row.clusters = many.clusters();
    row.ns_per_event = row.ns_min / row.events;
    return row;
}

double time_round(ManyShots& many) {
    many.rewind();  // every round plays the same shots
    const double start = thread_ns();
    many.play(many.shots_a_round());
    return (thread_ns() - start) / static_cast<double>(many.shots_a_round());
}

// Above this number of balls, the search through all boxes is not measured: it is far slower.
constexpr int kMostDirect = 2000;

std::vector<GasRow> growth_of(const BenchShotArgs& options, kernel::Isa isa) {
    std::vector<Gas> list;
    for (const ClusterModel clusters : {ClusterModel::kSequential, ClusterModel::kCompliant}) {
        const bool compliant = clusters == ClusterModel::kCompliant;
        for (const int n : {16, 100, 300, 1000, 10000}) {
            throw_if_interrupted();
            Scene scene = gas_scene(n, options.events, 1);
            scene.physics.clusters = clusters;
            const Plan plan = make_plan(scene, isa);
            for (const Search search : {Search::kDirect, Search::kTree}) {
                const bool chosen = plan.ball_search == search;
                // The two searches are compared pair by pair.
                if (!chosen && (compliant || (search == Search::kDirect && n > kMostDirect))) continue;
                Gas gas;
                gas.row.name = compliant ? "gas compliant" : "gas";
                gas.row.clusters = clusters;
                gas.row.balls = n;
                gas.row.search = search;
                gas.row.chosen = chosen;
                gas.plan = plan;
                gas.plan.ball_search = search;
                list.push_back(std::move(gas));
            }
        }
    }
    const auto samples = interleaved("bench shot: growth", list.size(), std::max(1, options.repeats / 3),
                                     [&list](std::size_t i) { return list[i].time(); });
    std::vector<GasRow> rows;
    double first = 0.0;
    for (std::size_t i = 0; i < list.size(); ++i) {
        Gas& gas = list[i];
        gas.row.ns_min = minimum(samples[i]);
        gas.row.ns_median = median(samples[i]);
        if (rows.empty() || rows.back().name != gas.row.name) first = gas.row.ns_min;
        gas.row.growth = gas.row.ns_min / first;
        rows.push_back(gas.row);
    }
    return rows;
}

}  // namespace

ShotBench measure_shots(const BenchShotArgs& options) {
    const kernel::Isa isa = chosen_isa();
    const std::vector<std::string> names = shot_names();
    std::vector<TimedShot> subjects;
    for (const std::string& name : names)
        for (int seed = 0; seed < options.seeds; ++seed)
            subjects.push_back({make_plan(shot_scene(name, static_cast<std::uint64_t>(seed)), isa)});
    for (TimedShot& s : subjects) {  // warms up
        throw_if_interrupted();
        s.time();
    }
    std::vector<ManyShots> batches;
    for (const std::string& name : many_names()) {
        batches.emplace_back(name, isa);
        time_round(batches.back());
    }
    const kernel::Isa baseline_isa =
        kernel::available(kernel::Isa::kV3) ? kernel::Isa::kV3 : kernel::Isa::kScalar;
    std::vector<double> baseline;
    const std::size_t all = subjects.size() + batches.size();
    const auto samples = interleaved("bench shot", all, options.repeats, [&](std::size_t i) {
        baseline.push_back(baseline_impact(baseline_isa));
        if (i >= subjects.size()) return time_round(batches[i - subjects.size()]);
        const double ns = subjects[i].time();
        subjects[i].profile();
        return ns;
    });
    for (std::size_t i = 0; i < subjects.size(); ++i) subjects[i].ns = samples[i];

    ShotBench bench;
    bench.cpu = processor();
    bench.compiler = __VERSION__;
    bench.baseline_isa = kernel::name(baseline_isa);
    bench.isa = kernel::name(isa);
    bench.baseline_ns = minimum(baseline);
    bench.seeds = options.seeds;
    bench.repeats = options.repeats;
    for (std::size_t k = 0; k < names.size(); ++k)
        bench.rows.push_back(row_of(names[k], &subjects[k * static_cast<std::size_t>(options.seeds)],
                                    options.seeds, bench.baseline_ns));
    for (std::size_t k = 0; k < batches.size(); ++k)
        bench.rows.push_back(
            row_of(batches[k], many_names()[k], samples[subjects.size() + k], bench.baseline_ns));
    if (options.growth) bench.growth = growth_of(options, isa);
    return bench;
}

namespace {

int run(const BenchShotArgs& options) {
    const ShotBench bench = measure_shots(options);
    print(options.json ? shot_bench_json(bench) : shot_bench_text(bench));
    return kOk;
}

}  // namespace

void add_bench_shot(Options& bench) {
    auto [command, args] = bench.command<BenchShotArgs>(
        "shot", "Whole breaks and shots in units of one baseline impact; growth with the number of balls",
        run);
    command.flag("--json", args.json, "Print JSON (default: off)");
    command.option("--seeds", &args.seeds, "N", "Seeds of every shot; a row is their median").in(1, 1000);
    add_repeat(command, args.repeats,
               "Interleaved rounds; a shot counts with its minimum (gases: a third of them)");
    command.option("--events", &args.events, "N", "Events of a gas at each size").in(10, 10000000);
    command.flag("--no-growth", args.growth, "Leave out the gases of 16 to 10000 balls (default: measured)");
    command.footer = "One baseline impact is the plain double march at N = 1000, timed in the same run.";
}

}  // namespace carom::tools
