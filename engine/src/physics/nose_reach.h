// How far from a nose the centre of a ball is that touches it.
#pragma once

#include <cmath>

namespace carom {

/// [R] From farther no ball meets a nose: in the air nose_reach() is up to sqrt(2) R.
inline constexpr double kNoseReach = 1.5;

/// [m] Distance of the centre from the line of a nose at this height, in the plane across it. A ball on the
/// cloth touches at the horizontal distance R - inset; the nose is the cylinder about its line that does so.
inline double nose_reach(double R, double height, double inset) {
    const double level = R - inset, up = height - R;
    return std::sqrt(level * level + up * up);
}

}  // namespace carom
