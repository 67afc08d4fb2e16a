// The geometry of a contact: its direction, its gap, and how fast the gap closes. One function per kind of
// part: another ball, a straight nose, a round nose (a point if its radius is 0, a wall around the balls if
// it is negative), the edge of a pocket, the cloth. docs/design/extending.md lists the files of a new kind.
#pragma once

#include <cmath>
#include <optional>

#include "carom/engine/ball_ball.h"
#include "carom/engine/geometry.h"
#include "carom/engine/tolerances.h"
#include "carom/engine/vec.h"
#include "contact/contact.h"
#include "physics/reach.h"

namespace carom {

struct BallAt {
    Vec3 r, v;
    double R;
    /// Whether it meets noses in space; on the cloth it meets them in the plane, whatever r.z and v.z are.
    bool flies = false;
};

struct Touch {
    Vec3 n;          ///< unit, from the ball into what it touches; level for balls on the cloth
    double gap;      ///< [m] negative: overlap
    double closing;  ///< [m/s] the rate at which the gap closes
    double bend;     ///< [m/s^2] deceleration of the closing by motion along a curved part

    /// [m/s^2] Closing acceleration of a ball with the (for two balls, relative) level acceleration `a`.
    double pressing(const Vec2& a) const { return dot(planar(n), a) - bend; }
};

/// A contact in the present state of its balls.
struct Meeting {
    Contact contact;
    BallAt ball, other;  ///< other: of two balls
    Touch touch;
    double pressing;  ///< [m/s^2] closing acceleration
};

/// [m] Distance of a touching ball's centre from a nose: horizontally, or in space if it flies.
template <class Part>
double reach_of(const Part& part, double R, bool flies) {
    return flies ? nose_reach(R, part.height, part.inset) : R - part.inset;
}
/// [m] Path radius of a touching ball around a nose on the cloth: 0 for a straight one, negative inside a
/// wall.
inline double turn_around(const CushionLine&, double) {
    return 0.0;
}
inline double turn_around(const Nose& nose, double R) {
    return R + nose.radius - nose.inset;
}

namespace detail {

inline Touch touch_spheres(const Vec3& apart, const Vec3& v, double reach) {
    const double d = length3(apart);
    const Vec3 n{apart[0] / d, apart[1] / d, apart[2] / d}, across = cross3(n, v);
    return {n, d - reach, dot3(n, v), dot3(across, across) / reach};
}

/// A nose in space.
/// @param out  level, from the centre of a round nose or from the foot on a straight one
template <class Part>
Touch touch_rim(const Vec2& out, double radius, bool round, const Part& nose, const BallAt& ball) {
    const double distance = length(out), level = distance - radius, up = ball.r[2] - nose.height;
    const Vec2 v = planar(ball.v);
    Vec2 away{0.0, 0.0};
    if (distance > 0.0) away = Vec2{out[0] / distance, out[1] / distance};
    const Vec3 apart{level * away[0], level * away[1], up};
    const double d = length3(apart);
    const Vec3 n{-(apart[0] / d), -(apart[1] / d), -(apart[2] / d)};
    const double across = (level * ball.v[2] - up * dot(away, v)) / d, around = cross(away, v);
    double bend = across * across / d;
    if (round && distance > 0.0) bend = bend + level / d * (around * around / distance);
    return {n, d - reach_of(nose, ball.R, true), dot3(n, ball.v), bend};
}

}  // namespace detail

/// Two balls in space.
inline Touch touch_ball(const BallAt& ball, const BallAt& other) {
    return detail::touch_spheres(other.r - ball.r, ball.v - other.v, ball.R + other.R);
}

/// Two balls on the cloth, or discs; ignores their heights.
inline Touch touch_level(const BallAt& ball, const BallAt& other, bool discs) {
    const Vec3 apart{other.r[0] - ball.r[0], other.r[1] - ball.r[1], 0.0};
    const Vec3 v{ball.v[0] - other.v[0], ball.v[1] - other.v[1], 0.0};
    return detail::touch_spheres(apart, v, contact_distance(ball.R, other.R, discs));
}

/// A ball and a straight nose, on either side of it.
inline Touch touch_part(const CushionLine& line, const BallAt& ball) {
    const Vec2 from = planar(ball.r) - line.from;
    const double &x = line.direction[0], &y = line.direction[1];
    if (ball.flies) {
        const double along = dot(line.direction, from);
        const Vec2 out{ball.r[0] - (line.from[0] + x * along), ball.r[1] - (line.from[1] + y * along)};
        return detail::touch_rim(out, 0.0, false, line, ball);
    }
    const double side = cross(line.direction, from), level = reach_of(line, ball.R, false);
    const bool right = side < 0.0;
    const Vec3 n = right ? Vec3{-y, x, 0.0} : Vec3{y, -x, 0.0};
    return {n, (right ? -side : side) - level, dot3(n, ball.v), 0.0};
}

/// A ball and a round nose; inside a wall the normal points outwards.
inline Touch touch_part(const Nose& nose, const BallAt& ball) {
    const Vec2 out = planar(ball.r) - nose.center;
    if (ball.flies) return detail::touch_rim(out, nose.radius, true, nose, ball);
    const double level = (nose.radius < 0.0 ? -1.0 : 1.0) * length(out), turn = turn_around(nose, ball.R);
    const Vec3 n{-(out[0] / level), -(out[1] / level), 0.0};
    const double around = cross(planar(n), planar(ball.v));
    return {n, level - turn, dot3(n, ball.v), around * around / turn};
}

/// A ball in the circle of a pocket, and its edge: the plane of the cloth, from inside.
inline Touch touch_part(const Pocket& pocket, const BallAt& ball) {
    const Vec2 out = planar(ball.r) - pocket.center;
    const double distance = length(out), around = cross(out, planar(ball.v)) / distance;
    const Vec3 n{out[0] / distance, out[1] / distance, 0.0};
    return {n, pocket.radius - distance, dot3(n, ball.v), -(around * around / distance)};
}

/// A ball above the cloth.
inline Touch touch_cloth(const BallAt& ball) {
    return {Vec3{0.0, 0.0, -1.0}, ball.r[2] - ball.R, -ball.v[2], 0.0};
}

/// Components of a vector along a line, and across it to its left.
inline Vec2 in_frame(const CushionLine& line, const Vec2& x) {
    return {dot(line.direction, x), cross(line.direction, x)};
}

/// Rounding error [m] of the distance between a foot point and the end of a cushion, for a centre at r.
double end_rounding(const Vec2& r, double line_length);

/// Whether a foot point `left` [m] before the end of a cushion has passed it. Within rounding the direction
/// of motion decides, so that a leaving ball is not mistaken for an arriving one: a contact cannot begin
/// under the condition that ends it. Beyond the end, the end point or the jaw applies.
inline bool past_end(double left, double rate, double pull, double rounding) {
    if (std::abs(left) > rounding) return left < 0.0;
    return rate < 0.0 || (rate == 0.0 && pull < 0.0);
}

/// Whether a foot point moving along a line is between its ends.
inline bool between_ends(double foot, double rate, double pull, double line_length, double rounding) {
    return !past_end(foot, rate, pull, rounding) && !past_end(line_length - foot, -rate, -pull, rounding);
}

/// Whether noses with these normals count as one: a cushion and the jaw that continues it.
inline bool act_as_one(const Vec2& n1, const Vec2& n2) {
    return dot(n1, n2) > 1.0 - 1e-6;
}

/// The point of a cushion or an arc nearest to a position, or the centre of another nose.
Vec2 nearest_point(const CushionLine& line, const Vec2& place);
Vec2 nearest_point(const Nose& nose, const Vec2& place);

/// Whether a position is on the far side of a round nose: inside a jaw, outside a wall around the balls.
inline bool behind(const Nose& nose, const Vec2& place) {
    return nose.sign() * length(place - nose.center) < nose.radius;
}

/// Whether the ball can touch the nose where it is: between the ends of a cushion or an arc, on the side on
/// which an arc acts, and not over the disc of a jaw.
/// @param slack [m] rounding of the direction from an arc's centre
bool beside(const CushionLine& line, const BallAt& ball);
bool beside(const Nose& nose, const BallAt& ball, double slack = 0.0);
/// Whether it touches the nose now, within kTouchTolerance and the rounding of the nose's ends.
bool touches_part(const CushionLine& line, const BallAt& ball);
bool touches_part(const Nose& nose, const BallAt& ball);

/// The same by the part of a contact.
inline Touch touch_part(const Geometry& geometry, const Contact& contact, const BallAt& ball) {
    return with_part(geometry, contact, [&](const auto& part) { return touch_part(part, ball); });
}
inline bool touches_part(const Geometry& geometry, const Contact& contact, const BallAt& ball) {
    return with_nose(geometry, contact, [&](const auto& nose) { return touches_part(nose, ball); });
}

// Pockets. Source: docs/reference/physics.md, "Pockets".

inline bool is_inside(const Pocket& pocket, const Vec2& here) {
    return length(here - pocket.center) < pocket.radius;
}
/// The pocket whose circle contains this position most deeply, or is nearest to it; -1 without pockets.
int pocket_under(const Geometry& geometry, const Vec2& here);
/// The same, if its circle contains this position; otherwise -1.
int pocket_around(const Geometry& geometry, const Vec2& here);

/// Whether cloth lies beyond the edge of the pocket at this position, rather than the pocket's back or the
/// area behind the rails. The cloth lies on the table's side of the pocket, and between two jaws a ball of
/// radius R gets at most R beyond the line of the rails.
bool is_bed(const Table& table, const Pocket& pocket, const Vec2& here, double R);

/// [m/s] Speed away from the edge of a ball that reaches it at the speed v_n with its centre `sunk` ball
/// radii below the height of a ball on the cloth; nothing if it does not come up. It hits the edge at an
/// angle whose cosine is 1 - sunk, keeps its tangential speed (no restitution, no friction), and rises by
/// sunk R: v^2 = ((1 - sunk) v_n)^2 - 2 g R sunk.
std::optional<double> climbs(double v_n, double sunk, double R, double gravity);

}  // namespace carom
