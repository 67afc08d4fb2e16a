// The time at which the next contact begins. One rule replaces all epsilons and spacers:
//  - a pair collides only while it is closing;
//  - a pair that overlaps and is closing collides now; one that overlaps and is receding does not collide.
#pragma once

#include <algorithm>
#include <cmath>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "carom/engine/geometry.h"
#include "carom/engine/vec.h"
#include "contact/roots.h"
#include "contact/touch.h"

namespace carom {

/// Translation of one ball from now: r + v t + a t^2 / 2, for 0 <= t <= horizon (its next state transition).
struct Path {
    Vec2 r, v, a;
    double horizon;  ///< s, may be infinite
    bool straight;   ///< v and a are parallel (rolling; sliding with u parallel to v; at rest)
    bool moves;
    double surface = 0.0;  ///< R |w| [m/s]; its rounding also limits the accuracy of the centre's speed
};

/// Time until the distance between two closing centres decreases to `reach` (R1 + R2); kNever if not within
/// both horizons.
double time_to_ball(const Path& ball1, const Path& ball2, double reach);

/// Time until the distance of the centre from a fixed point decreases to `reach` while closing.
double time_to_circle(const Path& ball, const Vec2& center, double reach);

/// Time until a ball of radius R touches a round nose. An arc acts on its own side only; from behind, a ball
/// passes through it.
double time_to_nose(const Path& ball, const Nose& nose, double R);

/// Time until a ball of radius R touches a straight nose, from either side, with the foot point between the
/// ends. The ends are separate circles.
double time_to_line(const Path& ball, const CushionLine& line, double R);

/// Time until a ball that moves along a cushion or around an arc passes an end of it; 0 if it passes it now,
/// kNever if the part has no ends.
double time_past_end(const Geometry& geometry, const Contact& contact, const Path& ball);

/// Time until the centre enters the circle of a pocket; 0 if it is inside.
double time_to_pocket(const Path& ball, const Vec2& center, double radius);
/// [s] Time until a ball on a straight path leaves the circle from inside; kNever if it does not move.
double time_to_edge(const Vec2& r, const Vec2& v, const Vec2& center, double radius);

/// [-] Margins of the quick rejections: a share of the reach, and a share of the summed terms.
inline constexpr double kApartShare = 1e-6;
inline constexpr double kTermShare = 1e-12;

/// Minimum of c + b t + a t^2 on [0, T] minus the rounding of its terms; T may be infinite.
inline double least(double c, double b, double a, double T) {
    if (b >= 0.0 && a >= 0.0) return c;
    if (!(T < kNever)) return -kNever;
    const double linear = b * T, square = a * T * T;
    double low = std::min(c, c + (linear + square));
    if (a > 0.0 && -b < 2.0 * a * T) low = c - b * b / (4.0 * a);
    return low - kTermShare * (std::abs(c) + std::abs(linear) + std::abs(square));
}

/// Quick rejection: whether a relative motion stays out of reach on [0, window] by a margin far above
/// rounding, so that the functions above would find nothing; false: call them. It needs no root and no
/// division by a length. Two projections give lower bounds of the distance: on the present direction to the
/// other centre, and on the normal of the relative velocity.
inline bool stays_apart_plain(const Vec2& r, const Vec2& v, const Vec2& a, double reach, double window) {
    if (!(window >= 0.0)) return true;
    const double far = reach * (1.0 + kApartShare);
    const double d2 = dot(r, r);
    const double towards = least(d2, dot(r, v), 0.5 * dot(r, a), window);
    if (towards > 0.0 && towards * towards > far * far * d2) return true;
    const double side = cross(r, v), bend = 0.5 * cross(a, v);
    const double across = side < 0.0 ? least(-side, 0.0, -bend, window) : least(side, 0.0, bend, window);
    return across > 0.0 && across * across > far * far * dot(v, v);
}

#if defined(__SSE2__)
/// The same with both projections at once and without branches, because the case of least() that applies is
/// unpredictable.
inline bool stays_apart(const Vec2& r, const Vec2& v, const Vec2& a, double reach, double window) {
    if (!(window >= 0.0)) return true;
    const double far = reach * (1.0 + kApartShare), d2 = dot(r, r), side = cross(r, v),
                 bend = 0.5 * cross(a, v);
    const __m128d zero = _mm_setzero_pd(), sign = _mm_set1_pd(-0.0);
    // Lanes: towards, across.
    const __m128d flip = _mm_and_pd(sign, _mm_cmplt_pd(_mm_set_pd(side, 0.0), zero));
    const __m128d flipped = _mm_unpackhi_pd(flip, flip);
    const __m128d c = _mm_xor_pd(flip, _mm_set_pd(side, d2)), b = _mm_set_pd(0.0, dot(r, v)),
                  k = _mm_xor_pd(_mm_move_sd(flipped, zero), _mm_set_pd(bend, 0.5 * dot(r, a)));
    const __m128d rises = _mm_and_pd(_mm_cmpge_pd(b, zero), _mm_cmpge_pd(k, zero));
    __m128d low = _mm_set1_pd(-kNever);
    if (window < kNever) {
        const __m128d T = _mm_set1_pd(window), linear = _mm_mul_pd(b, T),
                      square = _mm_mul_pd(_mm_mul_pd(k, T), T);
        const __m128d end = _mm_min_pd(_mm_add_pd(c, _mm_add_pd(linear, square)), c);
        const __m128d turns =
            _mm_and_pd(_mm_cmpgt_pd(k, zero),
                       _mm_cmplt_pd(_mm_xor_pd(sign, b), _mm_mul_pd(_mm_mul_pd(_mm_set1_pd(2.0), k), T)));
        const __m128d turn = _mm_sub_pd(c, _mm_div_pd(_mm_mul_pd(b, b), _mm_mul_pd(_mm_set1_pd(4.0), k)));
        low = _mm_or_pd(_mm_and_pd(turns, turn), _mm_andnot_pd(turns, end));
        const __m128d terms = _mm_add_pd(_mm_add_pd(_mm_andnot_pd(sign, c), _mm_andnot_pd(sign, linear)),
                                         _mm_andnot_pd(sign, square));
        low = _mm_sub_pd(low, _mm_mul_pd(_mm_set1_pd(kTermShare), terms));
    }
    low = _mm_or_pd(_mm_and_pd(rises, c), _mm_andnot_pd(rises, low));
    const __m128d limit = _mm_mul_pd(_mm_set1_pd(far * far), _mm_set_pd(dot(v, v), d2));
    return _mm_movemask_pd(_mm_and_pd(_mm_cmpgt_pd(low, zero), _mm_cmpgt_pd(_mm_mul_pd(low, low), limit))) !=
           0;
}
#else
inline bool stays_apart(const Vec2& r, const Vec2& v, const Vec2& a, double reach, double window) {
    return stays_apart_plain(r, v, a, reach, window);
}
#endif

/// The same for a straight line, on either side.
bool stays_off_line(const Path& ball, const CushionLine& line, double R, double window);

/// Time until a ball of radius R meets the part: a nose, or the circle of a pocket. kNever if a quick
/// rejection finds that it stays away for the whole window.
inline double time_to(const CushionLine& line, const Path& ball, double R, double window) {
    return stays_off_line(ball, line, R, window) ? kNever : time_to_line(ball, line, R);
}
inline double time_to(const Nose& nose, const Path& ball, double R, double window) {
    const bool apart =
        !nose.is_arc() && stays_apart(ball.r - nose.center, ball.v, ball.a, turn_around(nose, R), window);
    return apart ? kNever : time_to_nose(ball, nose, R);
}
inline double time_to(const Pocket& pocket, const Path& ball, double, double window) {
    const bool apart = stays_apart(ball.r - pocket.center, ball.v, ball.a, pocket.radius, window);
    return apart ? kNever : time_to_pocket(ball, pocket.center, pocket.radius);
}

// Flights: one method for balls, straight noses and round ones (flight.cpp).

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
