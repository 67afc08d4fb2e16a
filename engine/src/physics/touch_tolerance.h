// The overlap at which two bodies still count as touching.
#pragma once

#include <algorithm>
#include <cmath>

#include "carom/engine/tolerances.h"
#include "carom/engine/vec.h"

namespace carom {

// [-] Fraction of the largest coordinate that rounding can explain as an overlap: far from the origin (1e5 m)
// the rounding of a coordinate, 2^-53 of it, exceeds kTouchTolerance. Two coordinates and a difference cause
// up to four roundings.
inline constexpr double kTouchRounding = 0x1p-51;

/// [m] The largest overlap that still counts as touching, at this distance from the origin.
inline double touch_tolerance(const Vec2& p) {
    return std::max(kTouchTolerance, kTouchRounding * std::max(std::abs(p.x()), std::abs(p.y())));
}

}  // namespace carom
