// The ladder: every form of the march that the paper built, kept working and correct, and those past it. For
// the benchmark and the tests; simulations use march.h and batch.h.
#pragma once

#include <span>

#include "carom/kernel/batch.h"
#include "carom/kernel/march.h"

namespace carom::kernel {

using BatchFunction = void (*)(const ImpactBatch& batch, int n, const ImpactBatchResult& result) noexcept;

/// One form of the march for one instruction set. Exactly one of `march` and `batch` is set.
struct Rung {
    const char* name;
    const char* section;  ///< of the paper, or "past it"
    Isa isa;
    MarchFunction march;  ///< one impact a call
    BatchFunction batch;  ///< many
    bool portable_bits;   ///< the same bits on scalar, v3 and v4, with gcc and with clang
    /// Largest difference from the baseline at N = 1000, relative to the approach speed, where the step counts
    /// agree: on the paper's five states, and on 2000 random impacts (where chatter near stick amplifies rounding).
    double bound_five, bound_random;
    const char* idea;
};

/// All rungs, the baseline first, in the order of the paper;
/// those of an instruction set that this processor lacks too.
std::span<const Rung> ladder() noexcept;

}  // namespace carom::kernel
