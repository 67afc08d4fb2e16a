// carom bench shot: measures.
#include "bench/shot.h"

#include <malloc.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <numeric>

#include <memory>
#include "bench/clock.h"
#include "bench/five_states.h"
#include "bench/machine.h"
#include "bench/shot_cases.h"
#include "carom/engine/simulate.h"
#include "carom/kernel/march.h"
#include "console.h"
#include "options.h"
#include "reference/random_impacts.h"
#include "setup.h"

namespace carom::tools {
namespace {

/// The published march at N = 1000 on the five states of the paper: what costs are counted in.
class Baseline {
  public:
    Baseline() : isa_(kernel::available(kernel::Isa::kV3) ? kernel::Isa::kV3 : kernel::Isa::kScalar) {}

    void round() {
        const kernel::MarchFunction march = kernel::march_function(isa_);
        kernel::ImpactResult result;
        const double start = thread_ns();
        for (const BenchImpact& s : kFiveStates) march(s.ball1, s.ball2, s.params, 1000, result);
        times_.push_back((thread_ns() - start) / std::size(kFiveStates));
    }
    double ns() const { return minimum(times_); }
    const char* isa() const { return kernel::name(isa_); }

  private:
    kernel::Isa isa_;
    std::vector<double> times_;
};

/// One shot of one seed.
struct TimedShot {
    Plan plan;
    std::vector<double> ns;
    double least_profiled = 1e300;
    std::size_t events = 0;
    std::array<double, 5> split{};  ///< detect, resolve, kernel, cluster, queue [ns of the whole run]

    void time() {
        const double start = thread_ns();
        const Record record = simulate(plan);
        ns.push_back(thread_ns() - start);
        events = record.events.size();
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
    double clusters() const {
        const Record record = simulate(plan);
        return static_cast<double>(record.clusters.size());
    }
};

/// Calls every function of the list once a round, in a new
/// random order each, so that no drift of the clock favours one.
void interleave(const std::vector<std::function<void()>>& list, int rounds, const char* title) {
    reference::Generator rng(99);
    std::vector<std::size_t> order(list.size());
    std::iota(order.begin(), order.end(), 0u);
    ProgressLine progress(title);
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[rng.next() % i]);
        for (std::size_t k = 0; k < order.size(); ++k) {
            throw_if_interrupted();
            list[order[k]]();
            progress.show_bar(round * static_cast<long>(order.size()) + static_cast<long>(k) + 1,
                              rounds * static_cast<long>(order.size()));
        }
    }
}

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
        clusters.push_back(s->clusters());
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

/// A gas under one kind of search.
struct Gas {
    GasRow row;
    Plan plan;
    std::vector<double> ns;

    void time() {
        double begin = 0.0, bytes = 0.0;
        std::size_t first = 0;
        const double before = heap_bytes();
        SimulateOptions options;
        // The first call comes after the first event: set-up is over, and its memory is taken.
        options.progress_rounds = 1;
        options.progress = [&](std::size_t events, double) {
            if (begin != 0.0) return;
            bytes = heap_bytes() - before;
            first = events;
            begin = thread_ns();
        };
        const Record record = simulate(plan, options);
        ns.push_back((thread_ns() - begin) / static_cast<double>(record.events.size() - first));
        row.bytes_per_ball = bytes / row.balls;
    }
    static double heap_bytes() {
        const struct mallinfo2 info = mallinfo2();
        return static_cast<double>(info.uordblks + info.hblkhd);
    }
};

// Above this the loop through all boxes is only slow.
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
    std::vector<std::function<void()>> work;
    work.reserve(list.size());
    for (Gas& gas : list) work.emplace_back([&gas] { gas.time(); });
    interleave(work, std::max(1, options.repeats / 3), "bench shot: growth");
    std::vector<GasRow> rows;
    double first = 0.0;
    for (Gas& gas : list) {
        gas.row.ns_min = minimum(gas.ns);
        gas.row.ns_median = median(gas.ns);
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
            subjects.push_back({make_plan(shot_scene(name, static_cast<std::uint64_t>(seed)), isa), {}});
    Baseline baseline;
    std::vector<std::function<void()>> work;
    for (TimedShot& s : subjects) {
        work.emplace_back([&s] {
            s.time();
            s.profile();
        });
        work.emplace_back([&baseline] { baseline.round(); });
    }
    for (TimedShot& s : subjects) {  // warms up
        throw_if_interrupted();
        s.time();
    }
    interleave(work, options.repeats, "bench shot");

    ShotBench bench;
    bench.cpu = processor();
    bench.compiler = __VERSION__;
    bench.baseline_isa = baseline.isa();
    bench.isa = kernel::name(isa);
    bench.baseline_ns = baseline.ns();
    bench.seeds = options.seeds;
    bench.repeats = options.repeats;
    for (std::size_t k = 0; k < names.size(); ++k)
        bench.rows.push_back(row_of(names[k], &subjects[k * static_cast<std::size_t>(options.seeds)],
                                    options.seeds, bench.baseline_ns));
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
    auto args = std::make_shared<BenchShotArgs>();
    Options& command = bench.command(
        "shot", "Whole breaks and shots in units of one baseline impact; growth with the number of balls");
    command.flag("--json", args->json, "Print JSON (default: off)");
    Option& seeds =
        command.option("--seeds", &args->seeds, "N", "Seeds of every shot; a row is their median");
    seeds.range = {1, 1000};
    add_repeat(command, args->repeats,
               "Interleaved rounds; a shot counts with its minimum (gases: a third of them)");
    Option& events = command.option("--events", &args->events, "N", "Events of a gas at each size");
    events.range = {10, 10000000};
    command.flag("--no-growth", args->growth, "Leave out the gases of 16 to 10000 balls (default: measured)");
    command.footer = "One baseline impact is the plain double march at N = 1000, timed in the same run.";
    command.run = [args] { return run(*args); };
}

}  // namespace carom::tools
