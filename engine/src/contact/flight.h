// When a flying ball touches another ball, a straight nose or a round one, by one method without polynomials.
// The distance from the ball's centre to any of these is a convex function of position, so its second time
// derivative is at least -A, the negative length of the acceleration. A parabola of that curvature through
// the present distance and rate is therefore a lower bound: its root never passes the first contact, and the
// iteration converges quadratically. Uses only + - * / and square roots.
#pragma once

#include "carom/engine/geometry.h"
#include "carom/engine/vec.h"
#include "contact/roots.h"

namespace carom {

/// Translation of one ball, absolute or relative to another, from now: r + v t + a t^2 / 2.
struct Flight {
    Vec3 r, v, a;
    double horizon;  ///< [s], may be infinite
    double noise;    ///< [m/s] closing speeds up to this are rounding
};

/// Time until the distance |r| between two closing centres decreases to `reach`; kNever if not within the
/// horizon.
double flight_to_ball(const Flight& relative, double reach);

/// Time until a ball of radius R touches a straight nose while closing, with its foot between the ends.
double flight_to_line(const Flight& ball, const CushionLine& line, double R);

/// Time until a closing ball of radius R touches a round nose (radius 0: a point), from outside the circle
/// only: a ball over its disc touches nothing.
double flight_to_nose(const Flight& ball, const Nose& nose, double R);

/// Time until a centre above the line crosses it between its ends; kNever if it does not.
double flight_over_line(const Flight& ball, const CushionLine& line);

/// Time until a centre on a straight path is over a disc about the origin; 0 if it is already.
double flight_over_disc(const Vec2& r, const Vec2& v, double radius, double horizon);

/// Time until a centre on a straight path leaves the rectangle; kNever if it rests.
double flight_beyond(const Rectangle& bed, const Vec2& r, const Vec2& v);

}  // namespace carom
