// Impacts solved to a tolerance (docs/design/impact_kernel.md).
//
// The impact of the 2014 model (march.h) is a small ordinary differential equation in the normal impulse.
// This kernel solves it by the cheapest method that keeps the tolerance, instead of by small steps.
#pragma once

#include "carom/kernel/batch.h"
#include "carom/kernel/impact.h"
#include "carom/kernel/isa.h"

namespace carom::kernel {

/// Allowed range of tolerances; anything else, including NaN, is kBadParameter.
inline constexpr double kTightestTolerance = 1e-13;
inline constexpr double kLoosestTolerance = 1e-1;

/// Larger friction coefficients are kBadParameter here. Up to this value no ball can stick to the cloth
/// during an impact, as the equations assume.
inline constexpr double kLargestFriction = 1.0;

/// Largest ratios of the masses and of the radii. The tolerance is tested up to a mass ratio of 10; beyond
/// it, inputs made to be hard exceed it (docs/design/impact_kernel.md).
inline constexpr double kLargestMassRatio = 1e6, kLargestRadiusRatio = 4.0;
/// Largest mass ratio for the fast methods, which need equal radii: their error bound is tested up to it.
inline constexpr double kFastMassRatio = 10.0;

/// [-] Effect of an impulse on a ball of mass m, relative to its effect on one of two equal balls with the
/// reduced mass of m and `other`: 2 other/(m + other), from 0 to 2. The cloth friction of the pressed ball
/// scales with it: its product with mu_s may be at most kLargestFriction.
constexpr double impulse_share(double m, double other) {
    return 2.0 / (1.0 + m / other);
}

/// Whether the masses, radii and frictions of an impact have a solution by tolerance and by the march; reads
/// nothing else of `params`.
bool sizes_have_solution(const ImpactParams& params) noexcept;

/// Solves one impact of two balls of any masses and radii (docs/reference/physics.md, "Balls of different
/// size"). Two radii cost some ten times as much.
///
/// @param tolerance  largest error of any component of v and of R w after the impact, relative to the
/// approach speed; a tolerance above 1e-3 is solved as 1e-3. Rounding adds a few units in the last place of
/// the largest speed before the impact. `result.steps` is the number of evaluations of the slip directions
/// over the impact (sweeps), 1 for a closed form.
using ToleranceFunction = void (*)(const Ball& ball1, const Ball& ball2, const ImpactParams& params,
                                   double tolerance, ImpactResult& result) noexcept;

/// The kernel built for one instruction set (which must be available). All give the same bits.
ToleranceFunction tolerance_function(Isa isa) noexcept;

/// Solves every impact of a batch; the error bound holds for each. All instruction sets give the same bits,
/// whatever the length of the batch and the position of an impact in it; they may differ from those of
/// ToleranceFunction.
using ToleranceBatchFunction = void (*)(const ImpactBatch& batch, double tolerance,
                                        const ImpactBatchResult& result) noexcept;

/// The batch kernel built for one instruction set (which must be available).
ToleranceBatchFunction tolerance_batch_function(Isa isa) noexcept;

/// The name of a method in profiles: "closed_stick", "collocation_4", ...
const char* name(ToleranceMethod method) noexcept;

}  // namespace carom::kernel
