#include "contact/detect.h"

#include <algorithm>
#include <cmath>

#include "carom/engine/tolerances.h"
#include "contact/roots.h"
#include "contact/touch.h"
#include "physics/motion.h"

namespace carom {

namespace {

constexpr double kNoise = kClosingUlp * kEpsilon;  // [of the speeds]

// The functions below find when a distance decreases to `reach` (kSide = 1), or increases to it inside a
// round wall (kSide = -1).

struct Relative {
    Vec2 r, v, a;
    double noise;  // [m/s] closing speeds up to this are rounding
};

Vec2 at(const Relative& m, double t) {
    return {m.r.x() + t * (m.v.x() + 0.5 * t * m.a.x()), m.r.y() + t * (m.v.y() + 0.5 * t * m.a.y())};
}
Vec2 rate(const Relative& m, double t) {
    return {m.v.x() + t * m.a.x(), m.v.y() + t * m.a.y()};
}

// Closing speed at t [m/s], positive while the gap decreases.
template <int kSide>
double closing_speed(const Relative& m, double t) {
    const Vec2 r = at(m, t);
    const double d = length(r);
    return d > 0.0 ? kSide * (-dot(r, rate(m, t)) / d) : length(rate(m, t));
}

// At most one small step back, from a time with overlap to one without.
template <int kSide>
double outside(const Relative& m, double reach, double t, double gap, double closing) {
    if (!(gap < 0.0)) return t;
    const double back = closing > m.noise ? t + gap / closing : t;
    const double earlier = std::min(back, t - kEpsilon * t);
    if (!(earlier >= 0.0)) return t;
    const double earlier_gap = kSide * (length(at(m, earlier)) - reach);
    return earlier_gap >= 0.0 && earlier_gap <= -2.0 * gap ? earlier : t;
}

// Refines a root of the polynomial by Newton steps on the distance itself, |r(t)| - reach. Steps end when the
// gap no longer decreases (at a graze they would diverge).
template <int kSide>
double refine(const Relative& m, double reach, double t, double horizon) {
    double gap = kSide * (length(at(m, t)) - reach);
    for (int i = 0; i < 3 && gap != 0.0; ++i) {
        const double closing = closing_speed<kSide>(m, t);
        if (!(closing > m.noise)) break;
        const double next = std::clamp(t + gap / closing, 0.0, horizon);
        const double next_gap = kSide * (length(at(m, next)) - reach);
        if (!(std::abs(next_gap) < std::abs(gap))) break;
        t = next;
        gap = next_gap;
    }
    return gap < 0.0 ? outside<kSide>(m, reach, t, gap, closing_speed<kSide>(m, t)) : t;
}

// A contact that is pressed together becomes an impact once its closing speed exceeds the rounding and this
// fraction [-] of the speed that the closing acceleration reaches within the horizon (at most 1 s).
constexpr double kPressShare = 1e-12;

double press_delay(double closing_acceleration, double noise, double horizon) {
    return 2.0 * noise / closing_acceleration + kPressShare * std::min(horizon, 1.0);
}

// [-] Steps towards contact before the quartic is solved; and the largest gap left by the last step, over the
// reach.
constexpr int kApproaches = 16;
constexpr double kArrived = 1e-16;

// Straight relative path with the signed acceleration `alpha` along it. Solved in arc length, which is exact
// at a graze.
template <int kSide>
double along_line(const Relative& m, double reach, double speed, double alpha, double horizon) {
    const Vec2 e = m.v / speed;
    const double along = -dot(m.r, e);  // arc length of the closest approach
    if (kSide > 0 && !(along > 0.0)) return kNever;
    const double miss = std::abs(cross(m.r, e));
    if (kSide > 0 && !(miss < reach)) return kNever;
    // From inside every path meets the wall, even one along it that misses the circle by rounding.
    const double half_chord = std::sqrt(std::max(0.0, (reach - miss) * (reach + miss)));
    // c / (b + sqrt(b^2 - c)) with c = |r|^2 - reach^2 as a product avoids cancellation near contact.
    const double d = length(m.r);
    // From inside, the other end of the chord; at once, if the ball is outside by rounding and leaves.
    double s = kSide < 0 && (along > 0.0 || half_chord == 0.0)
                   ? along + half_chord
                   : (d - reach) * (d + reach) / (along + kSide * half_chord);
    if (kSide < 0) s = std::max(0.0, s);
    if (!(s >= 0.0)) return kNever;
    const double end_speed_squared = speed * speed + 2.0 * alpha * s;
    if (!(end_speed_squared >= 0.0)) return kNever;  // stops before the contact
    const double t = 2.0 * s / (speed + std::sqrt(end_speed_squared));
    return t <= horizon ? refine<kSide>(m, reach, t, horizon) : kNever;
}

// Advances from t, before which the gap cannot close, to contact. Returns true if contact is reached or is
// impossible within the horizon (t is then kNever). The distance curves by at least -|a|, so no contact is
// possible before a parabola of that curvature, with the present closing speed, closes the gap; near the root
// this is Newton's step. Returns false if progress is slow, near a graze: from there the quartic is accurate.
// From farther away it is not: the coefficients of |r|^2 - reach^2 are as large as the squares of the
// distances travelled, and at a graze their rounding (1e-11 m over 100 m) would decide.
bool approach(const Relative& m, double reach, double pull, double horizon, double& t) {
    for (int i = 0;; ++i) {
        const Vec2 r = at(m, t), v = rate(m, t);
        const double d = length(r), gap = d - reach, closing = -dot(r, v) / d;
        if (!(gap > 0.0)) {
            t = outside<1>(m, reach, t, gap, closing);
            return closing > m.noise;
        }
        if (i == kApproaches) return false;
        const double root = std::sqrt(closing * closing + 2.0 * pull * gap);
        const double step = closing > 0.0 ? 2.0 * gap / (closing + root) : (root - closing) / pull;
        t += step;
        if (!(t <= horizon)) {
            t = kNever;
            return true;
        }
        // The curvature of the distance, at most |v|^2 / d + |a|, leaves at most this gap.
        if ((dot(v, v) + pull * d) * (step * step) <= kArrived * reach * d) {
            t = outside<1>(m, reach, t, length(at(m, t)) - reach, closing);
            return closing > m.noise;
        }
    }
}

// First time within the horizon at which |r| reaches `reach`, closing or only touching; c0 = |r|^2 - reach^2
// now, or its negative inside.
template <int kSide>
double first_touch(const Relative& m, double reach, double c0, double horizon, bool straight) {
    const double speed = length(m.v), pull = length(m.a);
    if (speed == 0.0 && pull == 0.0) return kNever;
    if (c0 > 0.0) {
        const double gap = kSide * (length(m.r) - reach);
        if (horizon < kNever && gap > horizon * (speed + 0.5 * horizon * pull)) return kNever;  // too far
        if (pull == 0.0) return along_line<kSide>(m, reach, speed, 0.0, horizon);
        if (straight && speed > 0.0) {
            const double alpha = dot(m.a, m.v) / speed;
            // The closed form is valid while the motion does not reverse.
            if (speed + alpha * horizon >= -4.0 * kEpsilon * speed)
                return along_line<kSide>(m, reach, speed, alpha, horizon);
        }
    } else if (pull == 0.0) {
        // Touching, not closing, no acceleration: never, or on the other side of a round wall.
        return kSide > 0 ? kNever : along_line<kSide>(m, reach, speed, 0.0, horizon);
    }
    double near = 0.0;
    if (kSide > 0 && c0 > 0.0 && approach(m, reach, pull, horizon, near)) return near;
    const Vec2 r = near > 0.0 ? at(m, near) : m.r, v = rate(m, near);
    if (near > 0.0) {
        const double d = length(r);
        if (!(d > reach)) return near;  // it closes more slowly than rounding can resolve
        c0 = (d - reach) * (d + reach);
    }
    const double c[5] = {c0, kSide * (2.0 * dot(r, v)), kSide * (dot(v, v) + dot(r, m.a)),
                         kSide * dot(v, m.a), kSide * (0.25 * dot(m.a, m.a))};
    const double t = first_descent(c, horizon - near);
    return t == kNever ? kNever : refine<kSide>(m, reach, std::min(horizon, near + t), horizon);
}

// First contact that closes by more than rounding; slower grazes are skipped. A contact that closes only
// because it is pressed together begins when its closing speed can be distinguished from 0.
template <int kSide>
double time_to_reach(Relative m, double reach, double horizon, bool straight) {
    const double d = length(m.r);
    double c0 = kSide * (d - reach) * (d + reach);
    double elapsed = 0.0;
    if (c0 <= 0.0 && closing_speed<kSide>(m, 0.0) > m.noise) return 0.0;
    for (int grazes = 0; grazes < 4; ++grazes) {
        const Vec2 v0 = m.v;
        const double curving = -kSide * (dot(v0, v0) + dot(m.r, m.a));
        const bool pressed_now = c0 <= 0.0 && curving > 0.0 && kSide * dot(m.r, m.v) <= 0.0;
        const double t = pressed_now ? 0.0 : first_touch<kSide>(m, reach, c0, horizon, straight);
        if (t == kNever) return kNever;
        if (!pressed_now && closing_speed<kSide>(m, t) > m.noise) return elapsed + t;
        const Vec2 r = at(m, t), v = rate(m, t);
        const double closing_acceleration = -kSide * (dot(v, v) + dot(r, m.a)) / length(r);
        if (closing_acceleration > 0.0) {
            const double pressed = t + press_delay(closing_acceleration, m.noise, horizon - t);
            return pressed <= horizon ? elapsed + pressed : kNever;
        }
        m.r = r;
        m.v = v;
        c0 = 0.0;
        elapsed += t;
        horizon -= t;
        straight = false;
    }
    return kNever;
}

}  // namespace

double time_to_ball(const Path& b1, const Path& b2, double reach) {
    if (!b1.moves && !b2.moves) return kNever;
    const Relative m{b2.r - b1.r, b2.v - b1.v, b2.a - b1.a,
                     kNoise * ((length(b1.v) + b1.surface) + (length(b2.v) + b2.surface))};
    const bool straight = (b1.straight && !b2.moves) || (b2.straight && !b1.moves);
    return time_to_reach<1>(m, reach, std::min(b1.horizon, b2.horizon), straight);
}

double time_to_circle(const Path& ball, const Vec2& center, double reach) {
    if (!ball.moves) return kNever;
    const Relative m{ball.r - center, ball.v, ball.a, kNoise * (length(ball.v) + ball.surface)};
    return time_to_reach<1>(m, reach, ball.horizon, ball.straight);
}

namespace {

Relative after(const Relative& m, double t) {
    return {at(m, t), rate(m, t), m.a, m.noise};
}

// First contact with a round wall on its own side. The caller excludes directions beyond the ends of an arc.
double time_to_wall(Relative m, double radius, double reach, double horizon, bool straight) {
    const double d = length(m.r);
    double behind = 0.0;
    // A ball behind the wall passes through it, and can touch it only afterwards.
    if (radius < 0.0 && d > -radius)
        behind = time_to_reach<1>(m, -reach, horizon, straight);
    else if (radius > 0.0 && d < radius)
        behind = time_to_reach<-1>(m, reach, horizon, straight);
    if (behind == kNever) return kNever;
    if (behind > 0.0) m = after(m, behind);
    const double t = radius < 0.0 ? time_to_reach<-1>(m, -reach, horizon - behind, straight)
                                  : time_to_reach<1>(m, reach, horizon - behind, straight);
    return behind + t;
}

// Adds the times within the horizon at which x + v t + a t^2 / 2 is 0.
int add_roots(double x, double v, double a, double horizon, double* times) {
    const double D = v * v - 2.0 * a * x;
    if (!(D >= 0.0)) return 0;
    const double q = -(v + (v < 0.0 ? -1.0 : 1.0) * std::sqrt(D));
    int found = 0;
    for (const double t : {q != 0.0 ? 2.0 * x / q : kNever, a != 0.0 ? q / a : kNever})
        if (t > 0.0 && t < horizon) times[found++] = t;
    return found;
}

// First time at which a foot point outside [0, end] enters it.
double time_to_enter(double foot, double rate, double pull, double end, double horizon) {
    if (foot < 0.0) return first_descent_quadratic(-foot, -rate, -pull, horizon);
    if (foot > end) return first_descent_quadratic(foot - end, rate, pull, horizon);
    return kNever;
}

}  // namespace

double time_to_line(const Path& ball, const CushionLine& line, double R) {
    if (!ball.moves) return kNever;
    const Vec2 r = in_frame(line, ball.r - line.from), v = in_frame(line, ball.v), a = in_frame(line, ball.a);
    const double reach = reach_of(line, R, false), noise = kNoise * (length(ball.v) + ball.surface);
    const double rounding = end_rounding(ball.r, line.length);
    const auto foot_inside = [&](double t) {
        return between_ends(r.x() + t * (v.x() + 0.5 * t * a.x()), v.x() + t * a.x(), a.x(), line.length,
                            rounding);
    };
    double best = kNever;
    for (const double side : {1.0, -1.0}) {
        const double h0 = side * r.y() - reach, h1 = side * v.y(), h2 = side * a.y();
        const bool here = side * r.y() >= 0.0;  // the ball is on this side now
        double t = kNever;
        // The ball overlaps the nose and moves into it, or is pressed against it.
        if (here && h0 <= 0.0 && h1 < -noise)
            t = 0.0;
        else if (here && h0 <= 0.0 && h2 < 0.0 && !(h1 > noise && h1 * h1 > 2.0 * h2 * h0))
            t = std::max(0.0, -h1 / h2) + press_delay(-h2, noise, ball.horizon);
        else {
            t = first_descent_quadratic(h0, h1, h2, ball.horizon);
            // Touches more slowly than rounding can resolve, and is pressed into the nose by its
            // acceleration.
            if (t < kNever && h2 < 0.0 && !(h1 + t * h2 < -noise))
                t += press_delay(-h2, noise, ball.horizon - t);
        }
        if (t < best && t <= ball.horizon && h1 + t * h2 < -noise && foot_inside(t)) best = t;
        // A ball that touches the nose at its end can roll around it onto the cushion: it closes once the
        // foot enters.
        const double enter = time_to_enter(r.x(), v.x(), a.x(), line.length, ball.horizon);
        if (enter == kNever) continue;
        const double h = h0 + enter * (h1 + 0.5 * enter * h2), rate = h1 + enter * h2;
        if (h > 0.0 || !(h + reach > 0.0)) continue;
        double closing = kNever;
        if (rate < -noise)
            closing = enter;
        else if (rate <= noise && h2 < 0.0)
            closing = enter + press_delay(-h2, noise, ball.horizon - enter);
        if (closing < best && closing <= ball.horizon && foot_inside(closing)) best = closing;
    }
    return best;
}

bool stays_off_line(const Path& ball, const CushionLine& line, double R, double window) {
    const double side = cross(line.direction, ball.r - line.from), sign = side < 0.0 ? -1.0 : 1.0;
    return least(sign * side, sign * cross(line.direction, ball.v),
                 0.5 * sign * cross(line.direction, ball.a),
                 window) > reach_of(line, R, false) * (1.0 + kApartShare);
}

double time_to_nose(const Path& ball, const Nose& nose, double R) {
    const double reach = turn_around(nose, R);
    if (!nose.is_arc()) return time_to_circle(ball, nose.center, reach);
    if (!ball.moves) return kNever;
    const Relative m{ball.r - nose.center, ball.v, ball.a, kNoise * (length(ball.v) + ball.surface)};
    // The times at which the ball may come in front of the wall, or leave it: at most five. The size 16 is
    // for gcc 12, which warns if std::sort has fewer elements.
    double cuts[16] = {0.0};
    int count = 1;
    if (!nose.span.whole)
        for (const Vec2& end : {nose.span.from, nose.span.to})
            count += add_roots(cross(end, m.r), cross(end, m.v), cross(end, m.a), ball.horizon, cuts + count);
    std::sort(cuts, cuts + count);
    for (int i = 0; i < count; ++i) {
        const double begin = cuts[i], end = i + 1 < count ? cuts[i + 1] : ball.horizon;
        const double middle = end < kNever ? begin + 0.5 * (end - begin) : 2.0 * begin + 1.0;
        if (!nose.span.holds(at(m, middle))) continue;
        const double t =
            time_to_wall(i > 0 ? after(m, begin) : m, nose.radius, reach, end - begin, ball.straight);
        if (t < kNever) return begin + t;
    }
    return kNever;
}

namespace {

double leaves(double left, double rate, double pull, double rounding) {
    if (past_end(left, rate, pull, rounding)) return 0.0;
    return first_descent_quadratic(left, rate, pull, kNever);
}

double time_past(const CushionLine& line, const Path& ball) {
    const double foot = dot(line.direction, ball.r - line.from), rate = dot(line.direction, ball.v),
                 pull = dot(line.direction, ball.a), rounding = end_rounding(ball.r, line.length);
    return std::min(leaves(foot, rate, pull, rounding), leaves(line.length - foot, -rate, -pull, rounding));
}

double time_past(const Nose& nose, const Path& ball) {
    if (nose.span.whole) return kNever;
    const Vec2 out = ball.r - nose.center;
    const double rounding = end_rounding(out, 0.0);
    const auto passes = [&](const Vec2& end, double sign) {
        return leaves(sign * cross(end, out), sign * cross(end, ball.v), sign * cross(end, ball.a), rounding);
    };
    const double first = passes(nose.span.from, 1.0), second = passes(nose.span.to, -1.0);
    return nose.span.wide ? std::max(first, second) : std::min(first, second);
}

}  // namespace

double time_past_end(const Geometry& geometry, const Contact& contact, const Path& ball) {
    if (!contact.is_nose()) return kNever;
    return with_nose(geometry, contact, [&ball](const auto& nose) { return time_past(nose, ball); });
}

double time_to_pocket(const Path& ball, const Vec2& center, double radius) {
    const double d = length(ball.r - center);
    if (d < radius) return 0.0;
    return time_to_circle(ball, center, radius);
}

double time_to_edge(const Vec2& r, const Vec2& v, const Vec2& center, double radius) {
    const Vec2 out = r - center;
    const double speed2 = dot(v, v), along = dot(out, v);
    if (!(speed2 > 0.0)) return kNever;
    // The later root of |out + v t| = radius. It is real inside the circle; on the circle, rounding may make
    // it complex.
    const double inside = (radius - length(out)) * (radius + length(out));
    const double root = std::sqrt(std::max(0.0, along * along + speed2 * inside));
    return std::max(0.0, along > 0.0 ? inside / (along + root) : (root - along) / speed2);
}

}  // namespace carom
