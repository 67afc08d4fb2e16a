// The ladder: every variant of the march that the paper built, kept working and correct, and variants beyond
// it. For the benchmark and the tests; simulations use march.h and tolerance.h.
#pragma once

#include <span>

#include "carom/kernel/batch.h"
#include "carom/kernel/march.h"

namespace carom::kernel {

/// Marches every impact of a batch with n substeps, as MarchFunction does for one.
using BatchFunction = void (*)(const ImpactBatch& batch, int n, const ImpactBatchResult& result) noexcept;

/// One variant of the march for one instruction set. Exactly one of `march` and `batch` is set.
struct Variant {
    const char* name;
    const char* section;  ///< of the paper, or "past it"
    Isa isa;
    MarchFunction march;  ///< one impact per call
    BatchFunction batch;  ///< many impacts per call
    bool portable_bits;   ///< the same bits on scalar, v3 and v4, with gcc and with clang
    /// Largest difference from the baseline at N = 1000, relative to the approach speed, if the step counts
    /// agree: on the paper's five states, and on 2000 random impacts (where chatter near stick amplifies
    /// rounding).
    double bound_five, bound_random;
    const char* idea;
};

/// All variants, the baseline first, in the paper's order; each for all instruction sets, including those
/// that this processor lacks.
std::span<const Variant> ladder() noexcept;

}  // namespace carom::kernel
