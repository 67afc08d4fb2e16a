// carom-lab bench kernel: the measurement.
#include "bench/kernel.h"

#include <fmt/format.h>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "base/clock.h"
#include "base/console.h"
#include "base/machine.h"
#include "base/options.h"
#include "base/setup.h"
#include "bench/five_states.h"
#include "bench/timed_kernel.h"
#include "carom/kernel/march.h"
#include "carom/kernel/tolerance.h"
#include "reference/random_impacts.h"
#include "reference/solver.h"

namespace carom::tools {
namespace {

using namespace kernel;
using reference::Impact;

double difference(const ImpactResult& a, const ImpactResult& b, const Impact& in) {
    double most = 0.0;
    const auto take = [&most](double x) { most = std::isnan(x) ? INFINITY : std::max(most, std::fabs(x)); };
    for (int k = 0; k < 3; ++k) {
        take(a.v1[k] - b.v1[k]);
        take(a.v2[k] - b.v2[k]);
        take(in.params.R * (a.w1[k] - b.w1[k]));
        take(in.params.R * (a.w2[k] - b.w2[k]));
    }
    const double dx = in.ball2.r[0] - in.ball1.r[0], dy = in.ball2.r[1] - in.ball1.r[1];
    const double approach = ((in.ball1.v[0] - in.ball2.v[0]) * dx + (in.ball1.v[1] - in.ball2.v[1]) * dy) /
                            std::sqrt(dx * dx + dy * dy);
    return most / approach;
}

constexpr int kSubsteps = 1000;

/// Times every subject on both sets.
void time_all(std::vector<TimedKernel>& list, const ImpactSet& five, const ImpactSet& random, int repeats) {
    std::vector<ImpactResult> results(std::max(five.impacts.size(), random.impacts.size()));
    ProgressLine warming("bench kernel, warming up");
    // warms up, and finds how many calls far exceed one clock reading
    for (TimedKernel& s : list) {
        throw_if_interrupted();
        warming.show_bar(&s - list.data(), static_cast<long>(list.size()));
        const double once = s.time(five, kSubsteps, 2, results) * static_cast<double>(s.size(five));
        s.five_calls = std::max(1, static_cast<int>(3e5 / std::max(once, 1.0)));
        // The same for random impacts. If one call suffices, the caches need no earlier run.
        const double all = s.time(random, kSubsteps, 1, results) * static_cast<double>(s.size(random));
        s.random_calls = std::max(1, static_cast<int>(5e6 / std::max(all, 1.0)));
        s.random_calls = std::min(s.random_calls, 4);
    }
    interleaved("bench kernel", list.size(), repeats, [&](std::size_t i) {
        TimedKernel& s = list[i];
        // The first run brings code and data back into the caches.
        s.time(five, kSubsteps, 1, results);
        s.five_ns.push_back(s.time(five, kSubsteps, s.five_calls, results));
        if (s.random_calls > 1) s.time(random, kSubsteps, 1, results);
        s.random_ns.push_back(s.time(random, kSubsteps, s.random_calls, results));
        return 0.0;
    });
}

/// Differences from the baseline, and errors relative to the converged solution.
class Judge {
  public:
    Judge(const TimedKernel& baseline, const ImpactSet& five, const ImpactSet& random)
        : five_(five),
          random_(random),
          base_five_(results_of(baseline, five, kSubsteps)),
          base_random_(results_of(baseline, random, kSubsteps)),
          truth_five_(truth(five)),
          truth_random_(truth(random)) {}

    void judge(TimedKernel& s) const {
        KernelRow& row = s.row;
        const auto five = results_of(s, five_, kSubsteps), random = results_of(s, random_, kSubsteps);
        for (std::size_t i = 0; i < five.size(); ++i) {
            row.diff_five = std::max(row.diff_five, difference(five[i], base_five_[i], five_.impacts[i]));
            row.error_five = std::max(row.error_five, error(five[i], truth_five_[i], five_.impacts[i]));
            row.steps_mean += static_cast<double>(five[i].steps) / static_cast<double>(five.size());
        }
        std::vector<double> differences, errors;
        for (std::size_t i = 0; i < random.size(); ++i) {
            const bool same = random[i].steps == base_random_[i].steps;
            row.same_steps += same;
            differences.push_back(difference(random[i], base_random_[i], random_.impacts[i]));
            errors.push_back(error(random[i], truth_random_[i], random_.impacts[i]));
        }
        std::sort(differences.begin(), differences.end());
        row.diff_random_max = differences.back();
        row.diff_random_p99 = differences[differences.size() * 99 / 100];
        row.error_random_median = median(errors);
        row.error_random_max = *std::max_element(errors.begin(), errors.end());
    }

  private:
    static std::vector<reference::ImpactTruth> truth(const ImpactSet& set) {
        std::vector<reference::ImpactTruth> list;
        for (const Impact& i : set.impacts) {
            throw_if_interrupted();
            list.push_back(reference::reference_impact(i.ball1, i.ball2, i.params));
        }
        return list;
    }
    static double error(const ImpactResult& result, const reference::ImpactTruth& truth, const Impact& in) {
        return truth.ok ? reference::error_of(result, truth, in.params.R) : INFINITY;
    }
    const ImpactSet &five_, &random_;
    std::vector<ImpactResult> base_five_, base_random_;
    std::vector<reference::ImpactTruth> truth_five_, truth_random_;
};

std::vector<GrowthRow> growth_of(const std::vector<TimedKernel>& list, const ImpactSet& five) {
    std::vector<GrowthRow> rows;
    std::vector<ImpactResult> results(five.impacts.size());
    for (int n : {100, 1000, 10000}) {
        const auto times =
            interleaved(fmt::format("bench kernel, growth to N = {}", n), list.size(), 5,
                        [&](std::size_t i) { return list[i].time(five, n, n == 100 ? 8 : 2, results); });
        for (std::size_t i = 0; i < list.size(); ++i)
            rows.push_back({list[i].row.name, list[i].row.isa, n, minimum(times[i]), median(times[i])});
    }
    return rows;
}

/// Reads and writes more than any cache can contain.
void evict_caches() {
    static std::vector<char> memory(96u << 20);
    for (std::size_t i = 0; i < memory.size(); i += 64) memory[i] = static_cast<char>(memory[i] + 1);
#if defined(__x86_64__)
    for (std::size_t i = 0; i < memory.size(); i += 64) _mm_clflush(&memory[i]);
#endif
}

ShareRow shares_of(const TimedKernel& s, const ImpactSet& five, double probe_ns) {
    std::vector<ImpactResult> results(five.impacts.size());
    // A call for separating balls ends after validation and projection, the part before the loop.
    ImpactSet apart(five.impacts, five.impacts[0].params.cloth_slip, 8);
    for (Impact& i : apart.impacts) {
        for (double& v : i.ball1.v) v = -v;
        for (double& v : i.ball2.v) v = -v;
    }
    const auto least = [&](const ImpactSet& set, int n, int calls) {
        double best = 1e30;
        for (int i = 0; i < 9; ++i) best = std::min(best, s.time(set, n, calls, results));
        return best;
    };
    const double before = least(apart, 1000, 400), at_1000 = least(five, 1000, 20),
                 at_2000 = least(five, 2000, 20);
    ShareRow row{s.row.name, s.row.isa, before, 0.0, 0.0, 0.0, at_1000};
    // The time is linear in N; the constant part is spent before and after the loop.
    row.loop = std::min(at_2000 - at_1000, at_1000 - before);
    row.after = std::max(0.0, at_1000 - before - row.loop);
    std::vector<double> cold;
    for (const Impact& impact : five.impacts) {
        for (int i = 0; i < 3; ++i) {
            evict_caches();
            ImpactResult out;
            const double start = thread_ns();
            s.one(impact, 1000, out);
            cold.push_back(thread_ns() - start - probe_ns);
        }
    }
    row.cold = median(cold);
    return row;
}

double cost_of_a_probe() {
    std::vector<double> costs;
    for (int i = 0; i < 1000; ++i) {
        const double start = thread_ns();
        costs.push_back(thread_ns() - start);
    }
    return median(costs);
}

}  // namespace

KernelBench measure_kernel(const BenchKernelArgs& options) {
    const ClothSlip slip =
        options.cloth_slip == "as_published" ? ClothSlip::kAsPublished : ClothSlip::kConsistent;
    std::vector<Impact> states;
    for (const BenchImpact& s : kFiveStates) states.push_back({s.ball1, s.ball2, s.params});
    const ImpactSet five(states, slip, 16);
    const ImpactSet random(reference::random_impacts(options.seed, options.random), slip, 1);
    std::vector<TimedKernel> list = timed_kernels(options.only);

    KernelBench bench;
    bench.cpu = processor();
    bench.compiler = __VERSION__;
    bench.random = options.random;
    bench.cycle_ns = cycle_ns();
    bench.probe_ns = cost_of_a_probe();
    // The baseline is the v3 build if available, even under CAROM_ISA=scalar or v4, so that all ratios are
    // comparable.
    const Isa baseline_isa = available(Isa::kV3) ? Isa::kV3 : Isa::kScalar;
    bench.baseline_isa = name(baseline_isa);
    const TimedKernel baseline(
        {[f = march_function(baseline_isa)](const Impact& i, int n, ImpactResult& out) {
             f(i.ball1, i.ball2, i.params, n, out);
         },
         {}});
    const std::size_t subjects = list.size();
    list.push_back(baseline);
    // A user of the published loop may compile it with the paper's flags.
    for (const kernel::Variant& variant : kernel::ladder())
        if (std::string_view(variant.name) == "paper flags" && variant.isa == baseline_isa)
            list.emplace_back(call_of(variant));
    time_all(list, five, random, options.repeats);
    bench.baseline_ns = bench.baseline_random_ns = INFINITY;
    for (; list.size() > subjects; list.pop_back()) {
        bench.baseline_ns = std::min(bench.baseline_ns, minimum(list.back().five_ns));
        bench.baseline_random_ns = std::min(bench.baseline_random_ns, minimum(list.back().random_ns));
    }

    const Judge judge(baseline, five, random);
    ProgressLine judging("bench kernel, errors");
    for (TimedKernel& s : list) {
        throw_if_interrupted();
        judging.show_bar(static_cast<long>(bench.rows.size()), static_cast<long>(list.size()));
        judge.judge(s);
        KernelRow& row = s.row;
        row.ns_min = minimum(s.five_ns);
        row.ns_median = median(s.five_ns);
        row.ns_random_min = minimum(s.random_ns);
        row.ratio = bench.baseline_ns / row.ns_min;
        row.ratio_random = bench.baseline_random_ns / row.ns_random_min;
        row.cycles_per_step = row.ns_min / bench.cycle_ns / row.steps_mean;
        bench.rows.push_back(row);
    }
    if (options.growth) bench.growth = growth_of(list, five);
    ProgressLine sharing("bench kernel, shares");
    for (const TimedKernel& s : list) {
        throw_if_interrupted();
        sharing.show_bar(&s - list.data(), static_cast<long>(list.size()));
        if (s.one && s.row.name.rfind("march", 0) == 0)
            bench.shares.push_back(shares_of(s, five, bench.probe_ns));
    }
    return bench;
}

namespace {

int run(const BenchKernelArgs& options) {
    const KernelBench bench = measure_kernel(options);
    print(options.json ? kernel_bench_json(bench) : kernel_bench_text(bench));
    return kOk;
}

}  // namespace

void add_bench_kernel(Options& bench) {
    auto [command, args] = bench.command<BenchKernelArgs>(
        "kernel", "Every form of the ball-ball march, and every tolerance, against the plain march", run);
    command.flag("--json", args.json, "Print JSON (default: off)");
    command.option("--random", &args.random, "N", "Seeded random impacts beside the five states of the paper")
        .in(1, 1000000);
    command.option("--seed", &args.seed, "S", "Seed of the random impacts");
    add_repeat(command, args.repeats, "Interleaved rounds; minimum and median are over them");
    add_cloth_slip(command, args.cloth_slip, "Sign of the cloth slip inside the impact");
    command.flag("--no-growth", args.growth, "Leave out N = 100 and 10000 (default: measured)");
    command.option("--only", &args.only, "NAME",
                   "Time only this form, or all whose names begin with these words, such as 'tolerance'; may "
                   "be repeated "
                   "(default: all)");
    command.footer = "Without CAROM_ISA all instruction sets that this processor has run in one call.";
}

}  // namespace carom::tools
