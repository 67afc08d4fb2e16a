// Builds every single-impact rung for one instruction set. The including file defines CAROM_LADDER_ISA
// (scalar, v3, v4); rungs that need AVX2 and FMA are left out of scalar.
#pragma once

#include "ladder/batch_driver.h"
#include "ladder/branch_hints.h"
#include "ladder/branch_order.h"
#include "ladder/combined.h"
#include "ladder/fewer_roots.h"
#include "ladder/masks.h"
#include "ladder/packed_blocks.h"
#include "ladder/precomputed.h"
#include "ladder/reduced.h"
#include "ladder/rsqrt_newton.h"
#include "ladder/rsqrt_raw.h"
#include "ladder/simd_ssa.h"
#include "ladder/summed.h"
#include "ladder/summed_batch.h"
#include "ladder/two_stage.h"
#include "ladder/unconditional_roots.h"
#ifdef __AVX2__
#include "ladder/decoupled.h"
#include "ladder/explicit_fma.h"
#include "ladder/packed_march.h"
#include "ladder/paper_flags.h"
#include "ladder/simd_loop.h"
#include "ladder/simd_outside.h"
#endif

namespace carom::kernel::CAROM_LADDER_ISA {

#define CAROM_RUNG(function, Rung)                                              \
    void function(const Ball& b1, const Ball& b2, const ImpactParams& p, int n, \
                  ImpactResult& out) noexcept {                                 \
        drive<Rung>(b1, b2, p, n, out);                                         \
    }

CAROM_RUNG(fewer_roots, FewerRoots)
CAROM_RUNG(rsqrt_raw, RsqrtRaw)
CAROM_RUNG(rsqrt_newton, RsqrtNewton)
CAROM_RUNG(branch_hints, BranchHints)
CAROM_RUNG(branch_order, BranchOrder)
CAROM_RUNG(unconditional_roots, UnconditionalRoots)
CAROM_RUNG(masks, Masks)
CAROM_RUNG(two_stage, TwoStage)
CAROM_RUNG(precomputed, Precomputed)
CAROM_RUNG(packed_blocks, PackedBlocks)
CAROM_RUNG(simd_ssa, SimdSsa)
CAROM_RUNG(combined, Combined)
CAROM_RUNG(reduced, ReducedState)
CAROM_RUNG(summed, Summed)
#ifdef __AVX2__
CAROM_RUNG(explicit_fma, ExplicitFma)
CAROM_RUNG(simd_loop, SimdLoop)
CAROM_RUNG(packed, PackedExact)
CAROM_RUNG(extrapolated_seed, ExtrapolatedSeed)
CAROM_RUNG(pipelined, Pipelined)
CAROM_RUNG(carried_roots, CarriedRoots)
CAROM_RUNG(decoupled_roots, Decoupled)
void simd_around(const Ball& b1, const Ball& b2, const ImpactParams& p, int n, ImpactResult& out) noexcept {
    simd_outside(b1, b2, p, n, out);
}
CAROM_RUNG(paper_flags, PaperFlags)
#endif

void summed_batch(const ImpactBatch& batch, int n, const ImpactBatchResult& result) noexcept {
    summed_in_batch(batch, n, result);
}

#define CAROM_LANES(function, ...)                                                             \
    void function(const ImpactBatch& batch, int n, const ImpactBatchResult& result) noexcept { \
        batch_march<__VA_ARGS__>(batch, n, result);                                            \
    }
#ifdef __AVX2__
CAROM_LANES(four_lanes, 4, 1, LaneExactRoots, SeparateArithmetic)
CAROM_LANES(four_lanes_fma, 4, 1, LaneExactRoots, FusedArithmetic)
CAROM_LANES(four_lanes_rsqrt, 4, 1, LaneRsqrtRoots, FusedArithmetic)
CAROM_LANES(four_lanes_carried, 4, 1, LaneCarriedRoots, FusedArithmetic)
CAROM_LANES(two_by_four_lanes, 4, 2, LaneCarriedRoots, FusedArithmetic)
#endif
#ifdef __AVX512F__
CAROM_LANES(eight_lanes, 8, 1, LaneCarriedRoots, FusedArithmetic)
CAROM_LANES(two_by_eight_lanes, 8, 2, LaneCarriedRoots, FusedArithmetic)
#endif

#undef CAROM_LANES
#undef CAROM_RUNG

}  // namespace carom::kernel::CAROM_LADDER_ISA
