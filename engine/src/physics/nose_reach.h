// Distance from a nose to the centre of a ball that touches it.
#pragma once

#include <cmath>

namespace carom {

/// [R] No ball farther away touches a nose: in the air, nose_reach() is up to sqrt(2) R.
inline constexpr double kNoseReach = 1.5;

/// [m] Distance of the centre from the line of a nose at this height, in the plane perpendicular to it. The
/// nose is a cylinder about its line that a ball on the cloth touches at the horizontal distance R - inset.
inline double nose_reach(double R, double height, double inset) {
    const double level = R - inset, up = height - R;
    return std::sqrt(level * level + up * up);
}

}  // namespace carom
