// carom-lab accuracy kernel: accuracy of one ball-ball impact against time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/options.h"
#include "report/html.h"
#include "report/plot.h"

namespace carom::tools {

struct AccuracyKernelArgs {
    int count = 1000;  ///< seeded random impacts
    std::uint64_t seed = 1;
    int repeat = 9;               ///< interleaved rounds
    long most_substeps = 100000;  ///< largest N of the march
    bool json = false;
    std::string csv, plot, html;  ///< file names; empty: not written
};

/// One method at one setting. Times are processor time of the thread per impact [ns]; errors are the largest
/// component of v and R w relative to the converged solution, as a fraction of the approach speed.
struct KernelAccuracyRow {
    std::string method;        ///< "march", "march published", "tolerance", ...
    std::string kind;          ///< single, batch
    std::string setting;       ///< "N=1000", "1e-06", "" for a formula
    double value = 0.0;        ///< N or tolerance
    bool other_model = false;  ///< a formula for simpler physics: its error is the model's, not numerical
    double ns_min = 0.0, ns_median = 0.0, ns_max = 0.0;
    double error_median = 0.0, error_p99 = 0.0, error_max = 0.0;
    /// Tolerance only: the largest error as a fraction of the bound for its impact, which is the tolerance
    /// plus the effect of rounding on its speeds.
    std::optional<double> share_of_bound;
};

/// The time a method needs to reach an error: its fastest setting that reaches it for half of all impacts,
/// and for all of them. Infinite if none does.
struct KernelReach {
    std::string method, kind;
    double error = 0.0, ns_median = 0.0, ns_all = 0.0;
};

struct KernelAccuracy {
    std::string isa;
    /// impacts on which the two converged methods agree; only these are judged
    int count = 0;
    int disagreeing = 0;           ///< the other impacts, whose errors are not stated
    double worst_agreement = 0.0;  ///< largest difference of the two, as a fraction of the approach speed
    double slope = 0.0;            ///< of log median error over log N, march, N >= 100
    std::vector<KernelAccuracyRow> rows;
    std::vector<KernelReach> reach;
};

KernelAccuracy measure_kernel_accuracy(const AccuracyKernelArgs& args);

inline constexpr double kReachedErrors[] = {1e-3, 1e-6, 1e-9, 1e-12};

/// For every method, the time to reach each of these errors.
std::vector<KernelReach> reach_of(const std::vector<KernelAccuracyRow>& rows);

/// Slope of the straight line through (log x, log y) by least squares; NaN for fewer than two points.
double log_slope(const std::vector<double>& x, const std::vector<double>& y);

std::string kernel_accuracy_text(const KernelAccuracy& result);
std::string kernel_accuracy_json(const KernelAccuracy& result);
std::string kernel_accuracy_csv(const KernelAccuracy& result);
Plot kernel_accuracy_plot(const KernelAccuracy& result);
Report kernel_accuracy_report(const KernelAccuracy& result);

void add_accuracy_kernel(Options& accuracy);

}  // namespace carom::tools
