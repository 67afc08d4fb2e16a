// carom-lab accuracy kernel: the measurement.
#include "accuracy/kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "base/clock.h"
#include "base/console.h"
#include "base/setup.h"
#include "bench/timed_kernel.h"
#include "carom/kernel/closed_forms.h"
#include "carom/kernel/march.h"
#include "carom/kernel/tolerance.h"
#include "reference/batch_arrays.h"
#include "reference/solver.h"
#include "report/plot.h"
#include "report/table.h"

namespace carom::tools {
namespace {

using namespace kernel;

/// Least processor time of one sample [ns]: far longer than reading the clock.
constexpr double kSample = 2e6;

/// One method at one setting, for impacts one by one or as arrays.
struct Subject : KernelCall {
    Subject(KernelCall call, int substeps) : KernelCall(std::move(call)), n(substeps) { row.kind = kind(); }

    KernelAccuracyRow row;
    int n;  ///< of a march
    /// number of impacts in a sample, from the start of the list: a march needs the same time for all
    std::size_t timed = 1;
    int calls = 1;
    std::unique_ptr<BatchArrays> arrays;

    double once(const std::vector<Impact>& impacts) {
        ImpactResult out;
        const double start = thread_ns();
        for (int c = 0; c < calls; ++c) {
            if (one)
                for (std::size_t i = 0; i < timed; ++i) one(impacts[i], n, out);
            else
                many(*arrays, n);
        }
        return (thread_ns() - start) / (static_cast<double>(timed) * calls);
    }

    /// Chooses the sample size, and runs the code once before timing it.
    void prepare(const std::vector<Impact>& impacts) {
        const std::size_t least = one ? 8 : 64;
        timed = std::min(least, impacts.size());
        if (many) arrays = slice(impacts, timed);
        const double ns = once(impacts);
        const auto wanted = static_cast<std::size_t>(std::ceil(kSample / std::max(ns, 1.0)));
        timed = std::clamp(wanted, timed, impacts.size());
        calls = static_cast<int>(std::clamp<std::size_t>(wanted / timed, 1, 100));
        if (many) arrays = slice(impacts, timed);
    }

    std::vector<ImpactResult> results(const std::vector<Impact>& impacts) const {
        std::vector<ImpactResult> list(impacts.size());
        if (one) {
            for (std::size_t i = 0; i < impacts.size(); ++i) one(impacts[i], n, list[i]);
        } else {
            const BatchArrays all(impacts, ClothSlip::kConsistent);
            many(all, n);
            for (std::size_t i = 0; i < impacts.size(); ++i) list[i] = all.get(i);
        }
        return list;
    }

  private:
    static std::unique_ptr<BatchArrays> slice(const std::vector<Impact>& impacts, std::size_t n) {
        return std::make_unique<BatchArrays>(
            std::vector<Impact>(impacts.begin(), impacts.begin() + static_cast<std::ptrdiff_t>(n)),
            ClothSlip::kConsistent);
    }
};

Subject march(KernelCall call, const std::string& name, long n) {
    Subject s(std::move(call), static_cast<int>(n));
    s.row.method = name;
    s.row.setting = fmt::format("N={}", n);
    s.row.value = static_cast<double>(n);
    return s;
}

/// The fastest batch variant here at N = 1000.
const Variant& fastest_batch(Isa isa, const std::vector<Impact>& impacts) {
    const Variant* best = nullptr;
    double least = INFINITY;
    for (const Variant& variant : ladder()) {
        const bool meant = isa == Isa::kFastest ? available(variant.isa) : variant.isa == isa;
        if (!meant || variant.batch == nullptr) continue;
        Subject s = march(call_of(variant), variant.name, 1000);
        s.prepare(impacts);
        double ns = INFINITY;
        for (int i = 0; i < 3; ++i) ns = std::min(ns, s.once(impacts));
        if (ns < least) {
            least = ns;
            best = &variant;
        }
    }
    if (best == nullptr) throw std::runtime_error("the ladder has no batches for this instruction set");
    return *best;
}

KernelCall call_of_march(MarchFunction f) {
    return {[f](const Impact& i, int n, ImpactResult& out) { f(i.ball1, i.ball2, i.params, n, out); }, {}};
}

void add_marches(std::vector<Subject>& list, Isa isa, long most, const std::vector<Impact>& impacts) {
    const Variant& lanes = fastest_batch(isa, impacts);
    for (const long n : {10L, 30L, 100L, 300L, 1000L, 3000L, 10000L, 30000L, 100000L}) {
        if (n > most) break;
        list.push_back(march(call_of_march(summed_march_function(isa)), "march", n));
        list.push_back(march(call_of_march(march_function(isa)), "march published", n));
        list.push_back(march(call_of(lanes), std::string("march ") + lanes.name, n));
    }
}

void add_tolerances(std::vector<Subject>& list, Isa isa) {
    for (int p = 2; p <= 12; ++p) {
        // Read from text, so that it is exactly the number of a scene file.
        const std::string setting = fmt::format("1e-{}", p);
        const double tolerance = std::strtod(setting.c_str(), nullptr);
        for (const bool batch : {false, true}) {
            Subject& s = list.emplace_back(tolerance_call(isa, tolerance, batch), 0);
            s.row.method = "tolerance";
            s.row.setting = setting;
            s.row.value = tolerance;
        }
    }
}

void add_formulas(std::vector<Subject>& list) {
    using Formula = void (*)(const Ball&, const Ball&, const ImpactParams&, ImpactResult&) noexcept;
    for (const auto& [name, f] :
         {std::pair<const char*, Formula>{"closed form inelastic", &collide_inelastic},
          {"closed form elastic", &collide_elastic}}) {
        const auto one = [f = f](const Impact& i, int, ImpactResult& out) {
            f(i.ball1, i.ball2, i.params, out);
        };
        Subject& s = list.emplace_back(KernelCall{one, {}}, 0);
        s.row.method = name;
        s.row.other_model = true;
    }
}

/// The converged solution of every impact, twice, by independent code: power series in extended precision,
/// and collocation at the tightest tolerance.
struct Converged {
    std::vector<Impact> impacts;  ///< those on which both agree
    std::vector<reference::ImpactTruth> truth;
    int disagreeing = 0;
    double worst = 0.0;
};

/// The effect of rounding on an impact, as a fraction of the approach speed: a fast glancing ball has large
/// speeds but approaches slowly.
double rounding_share(const Impact& impact, double approach) {
    double most = approach;
    for (const Ball* ball : {&impact.ball1, &impact.ball2})
        for (int k = 0; k < 3; ++k)
            most = std::max({most, std::fabs(ball->v[k]), impact.params.R * std::fabs(ball->w[k])});
    return 64.0 * 0x1p-53 * most / approach;
}

Converged converge(const std::vector<Impact>& impacts, Isa isa) {
    Converged all;
    ProgressLine progress("accuracy kernel, converged solutions:");
    const ToleranceFunction collocation = tolerance_function(isa);
    for (const Impact& impact : impacts) {
        throw_if_interrupted();
        const reference::ImpactTruth truth =
            reference::reference_impact(impact.ball1, impact.ball2, impact.params);
        ImpactResult other;
        collocation(impact.ball1, impact.ball2, impact.params, kTightestTolerance, other);
        const double apart = truth.ok && other.status == ImpactStatus::kOk
                                 ? reference::error_of(other, truth, impact.params.R)
                                 : INFINITY;
        const bool agree =
            apart <= kTightestTolerance + rounding_share(impact, static_cast<double>(truth.approach));
        if (!agree) {
            ++all.disagreeing;
            continue;
        }
        all.worst = std::max(all.worst, apart);
        all.impacts.push_back(impact);
        all.truth.push_back(truth);
        progress.show_bar(static_cast<long>(all.impacts.size()), static_cast<long>(impacts.size()));
    }
    return all;
}

void judge(Subject& s, const Converged& converged) {
    const std::vector<ImpactResult> results = s.results(converged.impacts);
    std::vector<double> errors;
    double share = 0.0;
    for (std::size_t i = 0; i < results.size(); ++i) {
        const bool ok = results[i].status == ImpactStatus::kOk;
        errors.push_back(
            ok ? reference::error_of(results[i], converged.truth[i], converged.impacts[i].params.R)
               : INFINITY);
        const auto approach = static_cast<double>(converged.truth[i].approach);
        share =
            std::max(share, errors.back() / (s.row.value + rounding_share(converged.impacts[i], approach)));
    }
    if (s.row.method == "tolerance") s.row.share_of_bound = share;
    std::sort(errors.begin(), errors.end());
    s.row.error_median = median(errors);
    s.row.error_p99 = errors[(errors.size() * 99 + 99) / 100 - 1];
    s.row.error_max = errors.back();
}

}  // namespace

double log_slope(const std::vector<double>& x, const std::vector<double>& y) {
    const auto n = static_cast<double>(x.size());
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double a = std::log10(x[i]), b = std::log10(y[i]);
        sx += a;
        sy += b;
        sxx += a * a;
        sxy += a * b;
    }
    const double spread = n * sxx - sx * sx;
    return spread > 0.0 ? (n * sxy - sx * sy) / spread : NAN;
}

std::vector<KernelReach> reach_of(const std::vector<KernelAccuracyRow>& rows) {
    std::vector<KernelReach> list;
    for (const KernelAccuracyRow& first : rows) {
        const bool known = std::any_of(list.begin(), list.end(), [&first](const KernelReach& r) {
            return r.method == first.method && r.kind == first.kind;
        });
        if (known || first.other_model) continue;
        for (const double error : kReachedErrors) {
            KernelReach reach{first.method, first.kind, error, INFINITY, INFINITY};
            for (const KernelAccuracyRow& row : rows) {
                if (row.method != first.method || row.kind != first.kind) continue;
                if (row.error_median <= error) reach.ns_median = std::min(reach.ns_median, row.ns_min);
                if (row.error_max <= error) reach.ns_all = std::min(reach.ns_all, row.ns_min);
            }
            list.push_back(reach);
        }
    }
    return list;
}

KernelAccuracy measure_kernel_accuracy(const AccuracyKernelArgs& args) {
    const Isa isa = chosen_isa();
    const Converged converged = converge(reference::random_impacts(args.seed, args.count), isa);
    if (converged.impacts.empty())
        throw std::runtime_error("the two converged methods agree on no impact: nothing can be judged");
    std::vector<Subject> list;
    add_marches(list, isa, args.most_substeps, converged.impacts);
    add_tolerances(list, isa);
    add_formulas(list);
    for (Subject& s : list) s.prepare(converged.impacts);
    const auto samples = interleaved("accuracy kernel, times:", list.size(), args.repeat,
                                     [&](std::size_t i) { return list[i].once(converged.impacts); });
    KernelAccuracy result;
    result.isa = name(isa);
    result.count = static_cast<int>(converged.impacts.size());
    result.disagreeing = converged.disagreeing;
    result.worst_agreement = converged.worst;
    ProgressLine progress("accuracy kernel, errors:");
    std::vector<double> steps, errors;
    for (std::size_t i = 0; i < list.size(); ++i) {
        throw_if_interrupted();
        KernelAccuracyRow& row = list[i].row;
        judge(list[i], converged);
        row.ns_min = minimum(samples[i]);
        row.ns_median = median(samples[i]);
        row.ns_max = *std::max_element(samples[i].begin(), samples[i].end());
        result.rows.push_back(row);
        if (row.method == "march" && row.value >= 100.0) {
            steps.push_back(row.value);
            errors.push_back(row.error_median);
        }
        progress.show_bar(static_cast<long>(i) + 1, static_cast<long>(list.size()));
    }
    result.slope = log_slope(steps, errors);
    result.reach = reach_of(result.rows);
    return result;
}

namespace {

int run(const AccuracyKernelArgs& args) {
    check_plot_path(args.plot);
    check_page_path("--html", args.html);
    const KernelAccuracy result = measure_kernel_accuracy(args);
    write_report(args.csv, kernel_accuracy_csv(result));
    if (!args.plot.empty()) write_plot(kernel_accuracy_plot(result), args.plot);
    if (!args.html.empty()) write_html_report(kernel_accuracy_report(result), args.html);
    print(args.json ? kernel_accuracy_json(result) : kernel_accuracy_text(result));
    return kOk;
}

}  // namespace

void add_accuracy_kernel(Options& accuracy) {
    auto [command, args] = accuracy.command<AccuracyKernelArgs>(
        "kernel", "One impact: time and error of the march, of the tolerance kernel, of closed forms", run);
    command.option("--count", &args.count, "N", "Seeded random impacts").in(1, 1000000);
    command.option("--seed", &args.seed, "S", "Seed of the random impacts");
    add_repeat(command, args.repeat, "Interleaved rounds; times are minimum, median and maximum over them");
    command.option("--most-substeps", &args.most_substeps, "N", "Largest N of the march").in(10, 100000);
    add_reports(command, args.csv, args.json);
    add_plot(command, args.plot);
    add_html(command, args.html);
    command.footer = "Errors are shares of the approach speed, from a solution on which two methods agree.";
}

}  // namespace carom::tools
