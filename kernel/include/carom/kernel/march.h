// The published integration ("march"): explicit Euler steps in the normal impulse, one by one or summed.
#pragma once

#include <cstdint>

#include "carom/kernel/impact.h"
#include "carom/kernel/isa.h"

namespace carom::kernel {

/// Integrates one impact by N steps per half of the estimated impulse.
///
/// Source: Mathavan, Jackson, Parkin, "Numerical simulations of the frictional collisions of solid balls on a
/// rough surface", Sports Engineering 17 (2014); step rule of its published code, dP = (1 + e_b) m |v_n| / (2
/// N). The result has an error of up to about (1 + e_b) v_n / N and is a step function of its input; below
/// about N = 40 the integration gains energy by construction (hard case H24).
///
/// @param n  substeps N; less than 1 is kBadParameter. An impact that has not ended after kMarchStepLimit * n
/// steps has the status kStepLimit.
using MarchFunction = void (*)(const Ball& ball1, const Ball& ball2, const ImpactParams& params, int n,
                               ImpactResult& result) noexcept;

/// The integration built for one instruction set (which must be available). All give the same bits.
MarchFunction march_function(Isa isa) noexcept;

/// The same integration without visiting every step: the Euler sequence is summed exactly over blocks of up
/// to 1024 steps. Status and step count are those of march_function(). No velocity (including R w) differs by
/// more than kSummedDifference of the approach speed plus kSummedRounding * n of the largest input speed, the
/// possible rounding of the published integration. If rounding decides (ties of the last step, chatter near
/// stick), and for few substeps, the result is that of the published integration, bit for bit. All
/// instruction sets give the same bits.
MarchFunction summed_march_function(Isa isa) noexcept;

inline constexpr double kSummedDifference = 1e-10, kSummedRounding = 0x1p-53;

/// An impact of v_n > 0 ends after N + 1 to about N + 31 steps; only degenerate parameters come near this
/// limit.
inline constexpr std::int64_t kMarchStepLimit = 64;

}  // namespace carom::kernel
