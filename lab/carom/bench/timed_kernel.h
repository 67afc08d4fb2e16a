// Times for carom-lab bench kernel: every variant of the ladder and every tolerance, on single impacts or on
// batches.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "bench/kernel.h"
#include "ladder/ladder.h"
#include "reference/batch_arrays.h"
#include "reference/random_impacts.h"

namespace carom::tools {

using kernel::ClothSlip;
using kernel::ImpactResult;
using reference::BatchArrays;
using reference::Impact;

/// A list of impacts, both one by one and as arrays.
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

/// A kernel for one impact or for a batch; the other member is empty. Only a march uses n.
struct KernelCall {
    std::function<void(const Impact&, int n, ImpactResult&)> one;
    std::function<void(const BatchArrays&, int n)> many;
    const char* kind() const { return one ? "single" : "batch"; }
};
KernelCall call_of(const kernel::Variant& variant);
KernelCall tolerance_call(kernel::Isa isa, double tolerance, bool batch);

/// One subject: a variant, or a tolerance.
struct TimedKernel : KernelCall {
    explicit TimedKernel(KernelCall call) : KernelCall(std::move(call)) {}

    KernelRow row{};
    std::vector<double> five_ns, random_ns;  ///< per impact, one entry per round
    int five_calls = 1, random_calls = 1;

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

/// All forms on the instruction sets of this run (CAROM_ISA, or all of the processor), or those named in
/// `only`.
/// @throws UsageError listing them all if one is unknown
std::vector<TimedKernel> timed_kernels(const std::vector<std::string>& only);

std::vector<ImpactResult> results_of(const TimedKernel& kernel, const ImpactSet& set, int n);

}  // namespace carom::tools
