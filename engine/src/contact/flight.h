// When a ball in the air meets something: another ball, a straight nose, a round one. One method for all of
// them, without polynomials: the distance of the ball's centre from any of these is a convex function of its
// place, so in time its second derivative is at least -A, with A the length of the acceleration. A parabola
// of that curvature through the present distance and its rate is below the distance, and never steps past the
// first contact; it converges quadratically. Only + - * / and square roots.
#pragma once

#include "carom/engine/vec.h"
#include "contact/roots.h"

namespace carom {

/// Translation of one ball, or of one relative to another, from now on: r + v t + a t^2 / 2.
struct Flight {
    Vec3 r, v, a;
    double horizon;  ///< [s], may be infinite
    double noise;    ///< [m/s] closing speeds up to this are rounding
};

/// Time until the distance |r| of two centres decreases to
/// `reach` while closing; kNever if not within the horizon.
double flight_to_ball(const Flight& relative, double reach);

/// Time until the centre is `reach` away from the line through `from` while closing, with its foot between
/// the ends.
/// @param from, direction  of a horizontal line at height z; the direction is a unit vector
double flight_to_line(const Flight& ball, const Vec3& from, const Vec2& direction, double line_length,
                      double reach);

/// Time until the centre is `reach` away from a horizontal circle while closing; of radius 0: a point. Only
/// from outside of the circle: over its disc nothing is met any more.
double flight_to_circle(const Flight& ball, const Vec3& center, double radius, double reach);

/// Time until a centre above it passes from one side of the
/// line to the other between its ends; kNever if it does not.
double flight_over_line(const Flight& ball, const Vec2& from, const Vec2& direction, double line_length);

/// Time until a centre that moves straight on is over a disc about the origin: 0 if it is already.
double flight_over_disc(const Vec2& r, const Vec2& v, double radius, double horizon);

/// Time until a centre that moves straight on leaves the rectangle; kNever if it rests.
double flight_beyond(const Rectangle& bed, const Vec2& r, const Vec2& v);

}  // namespace carom
