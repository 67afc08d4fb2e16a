// carom-lab bench kernel: every variant of the ladder and every tolerance, side by side in one run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "carom/kernel/isa.h"

namespace carom::tools {

struct BenchKernelArgs {
    bool json = false;
    int random = 2000;  ///< seeded random impacts
    std::uint64_t seed = 1;
    int repeats = 9;     ///< interleaved rounds; minimum and median are over them
    bool growth = true;  ///< N = 100, 1000, 10000
    std::string cloth_slip = "consistent";
    std::vector<std::string> only;  ///< names, or their first whole words; empty: all
};

/// One row at N = 1000. Times are per impact [ns]; ratios are the baseline's time in the same run (the
/// published loop, with the faster of the usual and the paper's flags) divided by this time; differences
/// (from the baseline) and errors (from the converged solution) are fractions of the approach speed.
struct KernelRow {
    std::string name, section, kind;
    kernel::Isa isa;
    bool portable_bits;
    double ratio = 0.0, ratio_random = 0.0, ns_min = 0.0, ns_median = 0.0, ns_random_min = 0.0;
    double diff_five = 0.0, diff_random_max = 0.0, diff_random_p99 = 0.0;
    double error_five = 0.0, error_random_median = 0.0, error_random_max = 0.0;
    double cycles_per_step = 0.0, steps_mean = 0.0;  ///< steps over the five states
    int same_steps = 0;                              ///< of the random impacts
};

struct GrowthRow {
    std::string name;
    kernel::Isa isa;
    int n;
    double ns_min, ns_median;
};

/// The parts of one call's time [ns], and its time with cold code and data.
struct ShareRow {
    std::string name;
    kernel::Isa isa;
    double before, loop, after, cold, warm;
};

struct KernelBench {
    double baseline_ns = 0.0, baseline_random_ns = 0.0, cycle_ns = 0.0, probe_ns = 0.0;
    std::string baseline_isa, cpu, compiler;
    int random = 0;
    std::vector<KernelRow> rows;
    std::vector<GrowthRow> growth;
    std::vector<ShareRow> shares;
};

KernelBench measure_kernel(const BenchKernelArgs& options);
std::string kernel_bench_json(const KernelBench& bench);
std::string kernel_bench_text(const KernelBench& bench);

}  // namespace carom::tools
