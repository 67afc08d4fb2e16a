// Impacts of two balls that differ in mass or radius. Separate from the kernels of alike balls, which are the
// usual case, and built once.
#pragma once

#include "carom/kernel/impact.h"

namespace carom::kernel {

inline bool alike(const ImpactParams& p) {
    return p.radius_ratio == 1.0 && p.mass_ratio == 1.0;
}

/// ToleranceFunction for two masses or two radii.
void solve_unlike(const Ball& ball1, const Ball& ball2, const ImpactParams& params, double tolerance,
                  ImpactResult& result) noexcept;

/// MarchFunction for two masses or two radii.
void march_unlike(const Ball& ball1, const Ball& ball2, const ImpactParams& params, int n,
                  ImpactResult& result) noexcept;

}  // namespace carom::kernel
