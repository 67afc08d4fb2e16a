// Builds every single-impact rung for one instruction set. The including file defines CAROM_LADDER_ISA (scalar, v3, v4);
// rungs that need AVX2 and FMA are left out of scalar.
#pragma once

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
#include "ladder/two_stage.h"
#include "ladder/unconditional_roots.h"
#ifdef __AVX2__
#include "ladder/explicit_fma.h"
#include "ladder/simd_loop.h"
#include "ladder/simd_outside.h"
#endif

namespace carom::kernel::CAROM_LADDER_ISA {

#define CAROM_RUNG(function, Rung)                                                                              \
    void function(const Ball& b1, const Ball& b2, const ImpactParams& p, int n, ImpactResult& out) noexcept {     \
        drive<Rung>(b1, b2, p, n, out);                                                                           \
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
void simd_around(const Ball& b1, const Ball& b2, const ImpactParams& p, int n, ImpactResult& out) noexcept {
    simd_outside(b1, b2, p, n, out);
}
#endif

#undef CAROM_RUNG

}  // namespace carom::kernel::CAROM_LADDER_ISA
