// The ladder: every form of the march that the paper built, kept working and correct, and those past it. For
// the benchmark and the tests; simulations use march.h and tolerance.h.
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

/// The march with N substeps on every impact of a batch. Each result depends on its own impact alone, not on
/// what it shares vectors with, and is the same bits on every instruction set; it has the step count of
/// MarchFunction, or one beside it where the last step sits on a rounding tie, and differs from it by at most
/// about 1e-10 of the approach speed at N up to 1000; where rounding decides (glancing impacts, chatter near
/// stick) it has its bits (docs/kernel.md). `isa` must be available.
void collide_balls_batch(Isa isa, const ImpactBatch& batch, int n, const ImpactBatchResult& result) noexcept;

}  // namespace carom::kernel
