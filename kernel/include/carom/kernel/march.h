// The published march: Euler steps in the normal impulse.
#pragma once

#include "carom/kernel/batch.h"
#include "carom/kernel/impact.h"
#include "carom/kernel/isa.h"

namespace carom::kernel {

/// Marches one impact by N steps per half of the estimated impulse.
///
/// Source: Mathavan, Jackson, Parkin, "Numerical simulations of the frictional collisions of solid balls on a
/// rough surface", Sports Engineering 17 (2014); step rule of its published code, dP = (1 + e_b) m |v_n| / (2
/// N). The result is off by up to about (1 + e_b) v_n / N and is a step function of its input; below N of
/// about 40 the march gains energy by construction (hard case H24).
///
/// @param n  substeps N >= 1; fewer is kBadParameter.
/// The number of steps is bounded: an impact that has not ended after kMarchStepLimit * n steps is
/// kStepLimit.
using MarchFunction = void (*)(const Ball& ball1, const Ball& ball2, const ImpactParams& params, int n,
                               ImpactResult& result) noexcept;

/// The march built for one instruction set (which must be available). All give the same bits.
MarchFunction march_function(Isa isa) noexcept;

/// The march with N substeps on every impact of a batch. Each result depends on its own impact alone, not on
/// what it shares vectors with, and is the same bits on every instruction set; it has the step count of
/// MarchFunction, or one beside it where the last step sits on a rounding tie, and differs from it by at most
/// about 1e-10 of the approach speed at N up to 1000; where rounding decides (glancing impacts, chatter near
/// stick) it has its bits (docs/kernel.md). `isa` must be available.
void collide_balls_batch(Isa isa, const ImpactBatch& batch, int n, const ImpactBatchResult& result) noexcept;

/// An impact of v_n > 0 ends after N + 1 to about N + 31 steps; only degenerate parameters come near this bound.
inline constexpr long kMarchStepLimit = 64;

}  // namespace carom::kernel
