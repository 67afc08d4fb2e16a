// When a flying ball touches another ball, a straight nose or a round one, by one method without polynomials.
// The distance from the ball's centre to any of these is a convex function of position, so its second time
// derivative is at least -A, the negative length of the acceleration. A parabola of that curvature through
// the present distance and rate is therefore a lower bound: its root never passes the first contact, and the
// iteration converges quadratically. Uses only + - * / and square roots.
#include "contact/detect.h"

#include <algorithm>
#include <cmath>

#include "carom/engine/tolerances.h"
#include "contact/touch.h"

namespace carom {

namespace {

// [-] Steps of the search: the median was 3, the maximum 12 in 4000 random cases.
constexpr int kMostMarchSteps = 200;
// [-] Grazes skipped before the search ends.
constexpr int kMostGrazes = 4;

/// A distance and its first two time derivatives.
struct Distance {
    double d, rate, bend;
};

double dot_of(const Vec2& a, const Vec2& b) {
    return dot(a, b);
}
double dot_of(const Vec3& a, const Vec3& b) {
    return dot3(a, b);
}

/// The derivatives of the length of a vector x(t) with the derivatives v and a.
template <class Vector>
Distance of_length(const Vector& x, const Vector& v, const Vector& a) {
    const double d = std::sqrt(dot_of(x, x));
    if (!(d > 0.0)) return {0.0, 0.0, 0.0};
    const double rate = dot_of(x, v) / d;
    return {d, rate, (dot_of(v, v) + dot_of(x, a) - rate * rate) / d};
}

/// @param at  time -> Distance
/// @param curving  [m/s^2] upper bound of -bend
/// @param rounding  [m] of the distance
/// @param from  [s] start of the search
template <class At>
double first_contact(const At& at, double reach, double curving, double rounding, double noise, double from,
                     double horizon) {
    double t = from;
    int grazes = 0;
    for (int step = 0; step < kMostMarchSteps && t <= horizon; ++step) {
        const Distance now = at(t);
        const double gap = now.d - reach;
        if (gap <= rounding) {
            if (now.rate < -noise) return t;
            if (now.rate <= noise) {
                // Only touches. If it is pressed on, the contact begins once its speed can be distinguished
                // from 0.
                if (now.bend < 0.0) {
                    const double pressed = t + 2.0 * noise / -now.bend;
                    return pressed <= horizon ? pressed : kNever;
                }
                if (!(curving > 0.0) || ++grazes > kMostGrazes) return kNever;
                t += std::max(4.0 * noise / curving, 4.0 * kEpsilon * t);
                continue;
            }
        }
        const double open = std::max(gap, 0.0);
        const double root = std::sqrt(now.rate * now.rate + 2.0 * curving * open);
        double next;
        if (now.rate < 0.0) {
            next = 2.0 * open / (root - now.rate);
        } else {
            if (!(curving > 0.0)) return kNever;
            next = (now.rate + root) / curving;
        }
        // The time resolution is reached.
        if (!(t + next > t)) return now.rate < -noise ? t : kNever;
        t += next;
    }
    return kNever;
}

double place_rounding(const Flight& flight, double reach) {
    return 2.0 * kEpsilon *
           (reach + std::abs(flight.r.x()) + std::abs(flight.r.y()) + std::abs(flight.r.z()));
}

Vec3 place(const Flight& f, double t) {
    return f.r + t * (f.v + 0.5 * t * f.a);
}
Vec3 speed(const Flight& f, double t) {
    return f.v + t * f.a;
}

/// The times at which the foot of a centre on a line is between the ends.
struct Window {
    double from, to;
};
Window over(double foot, double rate, double line_length, double horizon) {
    if (rate == 0.0) return foot >= 0.0 && foot <= line_length ? Window{0.0, horizon} : Window{1.0, 0.0};
    const double one = -foot / rate, two = (line_length - foot) / rate;
    return {std::max(0.0, std::min(one, two)), std::min(horizon, std::max(one, two))};
}

/// Time until a centre on a straight path is over a disc at the origin; negative if it already is.
double time_over_disc(const Vec2& r, const Vec2& v, double radius) {
    const double out = (length(r) - radius) * (length(r) + radius), along = dot(r, v);
    if (radius == 0.0) return kNever;
    if (out < 0.0) return -1.0;
    const double root2 = along * along - dot(v, v) * out;
    return along < 0.0 && root2 > 0.0 ? out / (std::sqrt(root2) - along) : kNever;
}

}  // namespace

double flight_to_ball(const Flight& f, double reach) {
    const auto at = [&](double t) { return of_length(place(f, t), speed(f, t), f.a); };
    return first_contact(at, reach, length3(f.a), 4.0 * kEpsilon * reach, f.noise, 0.0, f.horizon);
}

double flight_to_line(const Flight& f, const CushionLine& line, double R) {
    // In the plane perpendicular to the line: the horizontal distance and the height.
    const auto across = [&](const Vec3& x) { return Vec2(cross(line.direction, planar(x)), x.z()); };
    const Flight g{f.r - Vec3(line.from.x(), line.from.y(), line.height), f.v, f.a, f.horizon, f.noise};
    const Window window =
        over(dot(line.direction, planar(g.r)), dot(line.direction, planar(g.v)), line.length, f.horizon);
    const double reach = reach_of(line, R, true);
    const Vec2 pull = across(g.a);
    const auto at = [&](double t) { return of_length(across(place(g, t)), across(speed(g, t)), pull); };
    return first_contact(at, reach, length(pull), place_rounding(f, reach), f.noise, window.from, window.to);
}

double flight_to_nose(const Flight& f, const Nose& nose, double R) {
    const double radius = nose.radius, reach = reach_of(nose, R, true);
    const Vec3 from = f.r - Vec3(nose.center.x(), nose.center.y(), nose.height);
    const Flight g{from, f.v, f.a, std::min(f.horizon, time_over_disc(planar(from), planar(f.v), radius)),
                   f.noise};
    const auto at = [&](double t) {
        const Vec3 x = place(g, t), v = speed(g, t);
        const Distance out = of_length(planar(x), planar(v), planar(g.a));
        return of_length(Vec2(std::max(0.0, out.d - radius), x.z()), Vec2(out.rate, v.z()),
                         Vec2(out.bend, g.a.z()));
    };
    const auto from_point = [&](double t) { return of_length(place(g, t), speed(g, t), g.a); };
    const double rounding = place_rounding(f, reach + radius), curving = length3(g.a);
    if (radius == 0.0) return first_contact(from_point, reach, curving, rounding, f.noise, 0.0, g.horizon);
    return first_contact(at, reach, curving, rounding, f.noise, 0.0, g.horizon);
}

double flight_over_line(const Flight& f, const CushionLine& line) {
    const Vec2 r = in_frame(line, planar(f.r) - line.from), v = in_frame(line, planar(f.v));
    if (!(r.y() * v.y() < 0.0)) return kNever;
    const double t = -r.y() / v.y(), foot = r.x() + t * v.x();
    return t <= f.horizon && foot >= 0.0 && foot <= line.length ? t : kNever;
}

double flight_over_disc(const Vec2& r, const Vec2& v, double radius, double horizon) {
    const double t = time_over_disc(r, v, radius);
    return t <= horizon ? std::max(0.0, t) : kNever;
}

double flight_beyond(const Rectangle& bed, const Vec2& r, const Vec2& v) {
    double first = kNever;
    for (const int axis : {0, 1}) {
        if (v[axis] == 0.0) continue;
        const double border = v[axis] > 0.0 ? bed[axis + 2] : bed[axis];
        first = std::min(first, std::max(0.0, (border - r[axis]) / v[axis]));
    }
    return first;
}

}  // namespace carom
