// carom bench kernel: measures.
#include "bench/kernel.h"

#include <fmt/format.h>
#include <immintrin.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <numeric>

#include "bench/clock.h"
#include "bench/five_states.h"
#include "bench/machine.h"
#include "carom/kernel/tolerance.h"
#include "console.h"
#include "ladder/ladder.h"
#include "reference/batch_arrays.h"
#include "reference/random_impacts.h"
#include "reference/solver.h"

namespace carom::tools {
namespace {

using namespace kernel;
using reference::BatchArrays;
using reference::Impact;

/// A list of impacts, once one by one and once as arrays.
struct ImpactSet {
    ImpactSet(std::vector<Impact> list, ClothSlip slip, int copies) : impacts(std::move(list)) {
        for (Impact& impact : impacts) impact.params.cloth_slip = slip;
        std::vector<Impact> many;
        for (int i = 0; i < copies; ++i) many.insert(many.end(), impacts.begin(), impacts.end());
        arrays = std::make_unique<BatchArrays>(many, slip);
        in_arrays = many.size();
    }
    std::vector<Impact> impacts;
    std::unique_ptr<BatchArrays> arrays;
    std::size_t in_arrays;
};

/// One thing to measure: a rung, or a tolerance, for one impact or for a batch.
struct TimedKernel {
    KernelRow row;
    std::function<void(const Impact&, int n, ImpactResult&)> one;
    std::function<void(const BatchArrays&, int n)> many;
    std::vector<double> five_ns, random_ns;  ///< per impact, one entry a round
    int five_calls = 1, random_calls = 1;

    /// Every impact of the set once.
    void run(const ImpactSet& set, int n, std::vector<ImpactResult>& results) const {
        if (one) {
            for (std::size_t i = 0; i < set.impacts.size(); ++i) one(set.impacts[i], n, results[i]);
        } else {
            many(*set.arrays, n);
        }
    }
    /// Impacts in one run.
    std::size_t size(const ImpactSet& set) const { return one ? set.impacts.size() : set.in_arrays; }

    double time(const ImpactSet& set, int n, int calls, std::vector<ImpactResult>& results) const {
        const double start = thread_ns();
        for (int c = 0; c < calls; ++c) run(set, n, results);
        return (thread_ns() - start) / (static_cast<double>(calls) * static_cast<double>(size(set)));
    }
};

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

std::vector<ImpactResult> results_of(const TimedKernel& subject, const ImpactSet& set, int n) {
    std::vector<ImpactResult> results(set.impacts.size());
    subject.run(set, n, results);
    if (subject.many)
        for (std::size_t i = 0; i < results.size(); ++i) results[i] = set.arrays->get(i);
    return results;
}

std::vector<TimedKernel> subjects(const std::vector<Isa>& isas) {
    std::vector<TimedKernel> list;
    for (const Rung& rung : ladder()) {
        if (std::find(isas.begin(), isas.end(), rung.isa) == isas.end()) continue;
        TimedKernel s;
        s.row = {std::string("march ") + rung.name, rung.section, rung.march ? "single" : "batch", rung.isa,
                 rung.portable_bits};
        if (rung.march)
            s.one = [f = rung.march](const Impact& i, int n, ImpactResult& out) {
                f(i.ball1, i.ball2, i.params, n, out);
            };
        else
            s.many = [f = rung.batch](const BatchArrays& a, int n) { f(a.batch, n, a.result); };
        list.push_back(std::move(s));
    }
    const struct {
        const char* name;
        double tolerance;
    } asked[] = {{"tolerance 1e-3", 1e-3}, {"tolerance 1e-6", 1e-6}, {"tolerance 1e-10", 1e-10}};
    for (Isa isa : isas) {
        for (const auto& a : asked) {
            TimedKernel s;
            s.row = {a.name, "past it", "single", isa, true};
            s.one = [f = tolerance_function(isa), t = a.tolerance](const Impact& i, int, ImpactResult& out) {
                f(i.ball1, i.ball2, i.params, t, out);
            };
            list.push_back(std::move(s));
            TimedKernel b;
            b.row = {a.name, "past it", "batch", isa, true};
            b.many = [f = tolerance_batch_function(isa), t = a.tolerance](const BatchArrays& arrays, int) {
                f(arrays.batch, t, arrays.result);
            };
            list.push_back(std::move(b));
        }
    }
    return list;
}

/// Whether a name is meant: the name itself, or its first words, unless another row has just these.
bool is_meant(const std::string& name, const std::string& wanted, bool exact) {
    return exact ? name == wanted : name.rfind(wanted + " ", 0) == 0;
}

/// Keeps the rows that are asked for.
void choose(std::vector<TimedKernel>& list, const std::vector<std::string>& only) {
    if (only.empty()) return;
    std::vector<bool> keep(list.size(), false);
    for (const std::string& wanted : only) {
        bool found = false;
        for (const bool exact : {true, false}) {
            if (found) break;
            for (std::size_t i = 0; i < list.size(); ++i) {
                if (!is_meant(list[i].row.name, wanted, exact)) continue;
                keep[i] = found = true;
            }
        }
        if (found) continue;
        std::string names;
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string& name = list[i].row.name;
            const auto same = [&name](const TimedKernel& s) { return s.row.name == name; };
            if (std::none_of(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(i), same))
                names += (names.empty() ? "" : ", ") + name;
        }
        throw UsageError(
            fmt::format("--only: there is no form \"{}\" on the instruction sets of this run; name one "
                        "of these, or first words of some: {}",
                        wanted, names));
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < list.size(); ++i)
        if (keep[i]) std::swap(list[kept++], list[i]);
    list.resize(kept);
}

constexpr int kSubsteps = 1000;

/// Rounds over all subjects in a new random order each, so that no drift of the clock favours one.
void time_all(std::vector<TimedKernel>& list, const ImpactSet& five, const ImpactSet& random, int repeats) {
    std::vector<ImpactResult> results(std::max(five.impacts.size(), random.impacts.size()));
    ProgressLine warming("bench kernel, warming up");
    for (TimedKernel& s : list) {  // warm up, and find how many calls make a block worth a probe
        throw_if_interrupted();
        warming.show_bar(&s - list.data(), static_cast<long>(list.size()));
        const double once = s.time(five, kSubsteps, 2, results) * static_cast<double>(s.size(five));
        s.five_calls = std::max(1, static_cast<int>(3e5 / std::max(once, 1.0)));
        // Random impacts likewise. A run so long that one will do needs no warming either.
        const double all = s.time(random, kSubsteps, 1, results) * static_cast<double>(s.size(random));
        s.random_calls = std::max(1, static_cast<int>(5e6 / std::max(all, 1.0)));
        s.random_calls = std::min(s.random_calls, 4);
    }
    reference::SplitMix64 rng(99);
    std::vector<std::size_t> order(list.size());
    std::iota(order.begin(), order.end(), 0u);
    ProgressLine progress("bench kernel");
    for (int round = 0; round < repeats; ++round) {
        for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[rng.next() % i]);
        for (std::size_t k = 0; k < order.size(); ++k) {
            throw_if_interrupted();
            TimedKernel& s = list[order[k]];
            // The first run brings code and data back into the caches.
            s.time(five, kSubsteps, 1, results);
            s.five_ns.push_back(s.time(five, kSubsteps, s.five_calls, results));
            if (s.random_calls > 1) s.time(random, kSubsteps, 1, results);
            s.random_ns.push_back(s.time(random, kSubsteps, s.random_calls, results));
            progress.show_bar(round * static_cast<long>(order.size()) + static_cast<long>(k) + 1,
                              repeats * static_cast<long>(order.size()));
        }
    }
}

/// Differences from the baseline and errors from the converged solution.
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
    ProgressLine progress("bench kernel, growth");
    long done = 0;
    for (int n : {100, 1000, 10000}) {
        std::vector<std::vector<double>> times(list.size());
        for (int round = 0; round < 5; ++round) {
            for (std::size_t i = 0; i < list.size(); ++i) {
                throw_if_interrupted();
                times[i].push_back(list[i].time(five, n, n == 100 ? 8 : 2, results));
                progress.show_bar(++done, 3L * 5L * static_cast<long>(list.size()));
            }
        }
        for (std::size_t i = 0; i < list.size(); ++i)
            rows.push_back({list[i].row.name, list[i].row.isa, n, minimum(times[i]), median(times[i])});
    }
    return rows;
}

/// Reads and writes more than any cache holds.
void evict_caches() {
    static std::vector<char> memory(96u << 20);
    for (std::size_t i = 0; i < memory.size(); i += 64) memory[i] = static_cast<char>(memory[i] + 1);
    for (std::size_t i = 0; i < memory.size(); i += 64) _mm_clflush(&memory[i]);
}

ShareRow shares_of(const TimedKernel& s, const ImpactSet& five, double probe_ns) {
    std::vector<ImpactResult> results(five.impacts.size());
    // Balls that separate leave after validation and projection: what comes before the loop.
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
    // Time is linear in N; what does not grow with it is before and after.
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

std::vector<Isa> chosen_isas() {
    Isa isa{};
    const IsaChoice choice = isa_from_environment(isa);
    if (choice == IsaChoice::kUnknownName) throw UsageError("CAROM_ISA: unknown; scalar, v3 or v4");
    if (choice == IsaChoice::kUnavailable) throw UsageError("CAROM_ISA: this processor does not have it");
    const char* forced = std::getenv("CAROM_ISA");
    if (forced != nullptr && *forced != '\0') return {isa};
    std::vector<Isa> list;
    for (Isa candidate : {Isa::kScalar, Isa::kV3, Isa::kV4})
        if (available(candidate)) list.push_back(candidate);
    return list;
}

}  // namespace

std::vector<KernelRow> kernel_rows(const BenchOptions& options) {
    std::vector<TimedKernel> list = subjects(chosen_isas());
    choose(list, options.only);
    std::vector<KernelRow> rows;
    rows.reserve(list.size());
    for (const TimedKernel& s : list) rows.push_back(s.row);
    return rows;
}

KernelBench measure_kernel(const BenchOptions& options) {
    if (options.random < 1) throw UsageError("--random: expected at least 1");
    const ClothSlip slip =
        options.cloth_slip == "as_published" ? ClothSlip::kAsPublished : ClothSlip::kConsistent;
    std::vector<Impact> states;
    for (const BenchImpact& s : kFiveStates) states.push_back({s.ball1, s.ball2, s.params});
    const ImpactSet five(states, slip, 16);
    const ImpactSet random(reference::random_impacts(options.seed, options.random), slip, 1);
    std::vector<TimedKernel> list = subjects(chosen_isas());
    choose(list, options.only);

    KernelBench bench;
    bench.cpu = processor();
    bench.compiler = __VERSION__;
    bench.random = options.random;
    bench.cycle_ns = cycle_ns();
    bench.probe_ns = cost_of_a_probe();
    // The baseline is the v3 build where there is one, also under CAROM_ISA=scalar or v4: all ratios mean the same.
    TimedKernel baseline;
    const Isa baseline_isa = available(Isa::kV3) ? Isa::kV3 : Isa::kScalar;
    bench.baseline_isa = name(baseline_isa);
    baseline.row.name = "baseline of all ratios";
    baseline.one = [f = march_function(baseline_isa)](const Impact& i, int n, ImpactResult& out) {
        f(i.ball1, i.ball2, i.params, n, out);
    };
    list.push_back(baseline);
    time_all(list, five, random, options.repeats);
    bench.baseline_ns = minimum(list.back().five_ns);
    bench.baseline_random_ns = minimum(list.back().random_ns);
    list.pop_back();

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

int run_bench_kernel(const BenchOptions& options) {
    const KernelBench bench = measure_kernel(options);
    print(options.json ? kernel_bench_json(bench) : kernel_bench_text(bench));
    return kOk;
}

}  // namespace carom::tools
