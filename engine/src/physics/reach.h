// Distances at which a ball touches: a nose, or anything within rounding.
#pragma once

#include <algorithm>
#include <cmath>

#include "carom/engine/tolerances.h"
#include "carom/engine/vec.h"

namespace carom {

/// [R] No ball farther away touches a nose: in the air, nose_reach() is up to sqrt(2) R.
inline constexpr double kNoseReach = 1.5;

/// [m] Distance of the centre from the line of a nose at this height, in the plane perpendicular to it. The
/// nose is a cylinder about its line that a ball on the cloth touches at the horizontal distance R - inset.
inline double nose_reach(double R, double height, double inset) {
    const double level = R - inset, up = height - R;
    return std::sqrt(level * level + up * up);
}

// [-] Fraction of the largest coordinate that rounding can explain as an overlap: far from the origin (1e5 m)
// the rounding of a coordinate, 2^-53 of it, exceeds kTouchTolerance. Two coordinates and a difference cause
// up to four roundings.
inline constexpr double kTouchRounding = 0x1p-51;

/// [m] The largest overlap that still counts as touching, at this distance from the origin.
inline double touch_tolerance(const Vec2& p) {
    return std::max(kTouchTolerance, kTouchRounding * std::max(std::abs(p.x()), std::abs(p.y())));
}

}  // namespace carom
