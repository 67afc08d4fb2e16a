// When does the next contact begin? One rule everywhere, instead of any epsilon or spacer: a pair collides
// only while closing; overlapped and closing means now; overlapped and receding means no event.
#pragma once

#include <algorithm>
#include <cmath>

#include "carom/engine/vec.h"
#include "contact/roots.h"

namespace carom {

/// Translation of one ball from now on: r + v t + a t^2 / 2, for 0 <= t <= horizon (its own next transition).
struct Path {
    Vec2 r, v, a;
    double horizon;  ///< s, may be infinite
    bool straight;   ///< v and a are parallel (rolling; sliding with u parallel to v; at rest)
    bool moves;
    double surface = 0.0;  ///< R |w| [m/s]: the speed of the centre is not known better than to the rounding
                           ///< of this, either
};

/// Closing speeds below this many ulp of the speeds involved (of the centres and of the surfaces) are
/// rounding noise of the projection, not an approach.
inline constexpr double kClosingUlp = 8.0;

/// Time until the centres of two balls come within `reach`
/// (R1 + R2) while closing; kNever if not within both horizons.
double time_to_ball(const Path& ball1, const Path& ball2, double reach);

/// Time until the centre comes within `reach` of a fixed point while closing.
double time_to_circle(const Path& ball, const Vec2& center, double reach);

/// Time until the centre comes within R of a segment of a straight line (its ends are circles of their own),
/// from either side, with the foot point between the ends.
/// @param direction unit, from -> to
double time_to_line(const Path& ball, const Vec2& from, const Vec2& direction, double line_length, double R);

/// How far from a cushion's end [m] a foot point may be by rounding, for a centre at r.
double end_rounding(const Vec2& r, double line_length);

/// Whether a foot point `left` [m] before a cushion's end has passed it. Within rounding its direction
/// decides, so that a ball that runs off the end is not taken for one that arrives: what ends a contact here
/// does not begin it. Beyond the end, its tip or the jaw takes over.
bool past_end(double left, double rate, double pull, double rounding);

/// Time until the centre enters a pocket's circle; 0 if it is inside.
double time_to_pocket(const Path& ball, const Vec2& center, double radius);

/// Margins of the rejects: a share of the reach, and a share of the terms that are summed.
inline constexpr double kApartShare = 1e-6;
inline constexpr double kTermShare = 1e-12;

/// Least value of c + b t + a t^2 on [0, T] less the rounding of its terms; T may be infinite.
inline double least(double c, double b, double a, double T) {
    if (b >= 0.0 && a >= 0.0) return c;
    if (!(T < kNever)) return -kNever;
    const double linear = b * T, square = a * T * T;
    double low = std::min(c, c + (linear + square));
    if (a > 0.0 && -b < 2.0 * a * T) low = c - b * b / (4.0 * a);
    return low - kTermShare * (std::abs(c) + std::abs(linear) + std::abs(square));
}

/// Whether a relative motion stays out of reach on [0, window], by a margin far above rounding: then the functions
/// above would find nothing there. No root, no division by a length; false where a look is needed. Two projections
/// bound the distance from below: on the direction to the other centre now, and across the relative velocity.
inline bool stays_apart(const Vec2& r, const Vec2& v, const Vec2& a, double reach, double window) {
    if (!(window >= 0.0)) return true;
    const double far = reach * (1.0 + kApartShare);
    const double d2 = dot(r, r);
    const double towards = least(d2, dot(r, v), 0.5 * dot(r, a), window);
    if (towards > 0.0 && towards * towards > far * far * d2) return true;
    const double side = cross(r, v), bend = 0.5 * cross(a, v);
    const double across = side < 0.0 ? least(-side, 0.0, -bend, window) : least(side, 0.0, bend, window);
    return across > 0.0 && across * across > far * far * dot(v, v);
}

/// The same for a straight line, from either side.
bool stays_off_line(const Path& ball, const Vec2& from, const Vec2& direction, double R, double window);

}  // namespace carom
