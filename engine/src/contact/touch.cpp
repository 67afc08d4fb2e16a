#include "contact/touch.h"

#include <algorithm>
#include <limits>

namespace carom {

namespace {

// [ulp of the coordinates and the length] A foot point within this distance of the end of a cushion is at the
// end: four roundings of position, end and projection.
constexpr double kEndUlp = 4.0;

}  // namespace

double end_rounding(const Vec2& r, double line_length) {
    return kEndUlp * kEpsilon * (std::abs(r.x()) + std::abs(r.y()) + line_length);
}

Vec2 nearest_point(const CushionLine& line, const Vec2& place) {
    return line.from + line.direction * std::clamp(dot(line.direction, place - line.from), 0.0, line.length);
}

Vec2 nearest_point(const Nose& nose, const Vec2& place) {
    if (!nose.is_arc()) return nose.center;
    const Vec2 out = place - nose.center;
    const double radius = std::abs(nose.radius);
    if (nose.span.holds(out)) return nose.center + radius / length(out) * out;
    const bool first = dot(nose.span.from, out) > dot(nose.span.to, out);
    return nose.center + radius * (first ? nose.span.from : nose.span.to);
}

bool beside(const CushionLine& line, const BallAt& ball) {
    return between_ends(dot(line.direction, planar(ball.r) - line.from), 0.0, 0.0, line.length, 0.0);
}

bool beside(const Nose& nose, const BallAt& ball, double slack) {
    if (nose.span.whole && !ball.flies) return true;
    const Vec2 place = planar(ball.r);
    return !behind(nose, place) && nose.span.holds(place - nose.center, slack);
}

bool touches_part(const CushionLine& line, const BallAt& ball) {
    const Vec2 here = planar(ball.r);
    return touch_part(line, ball).gap <= kTouchTolerance &&
           between_ends(dot(line.direction, here - line.from), dot(line.direction, planar(ball.v)), 0.0,
                        line.length, end_rounding(here, line.length));
}

bool touches_part(const Nose& nose, const BallAt& ball) {
    return touch_part(nose, ball).gap <= kTouchTolerance &&
           beside(nose, ball, end_rounding(planar(ball.r), 0.0));
}

int pocket_under(const Geometry& geometry, const Vec2& here) {
    int under = -1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < geometry.pockets.size(); ++i) {
        const Pocket& pocket = geometry.pockets[i];
        const double beyond = length(here - pocket.center) - pocket.radius;
        if (!(beyond < least)) continue;
        least = beyond;
        under = static_cast<int>(i);
    }
    return under;
}

int pocket_around(const Geometry& geometry, const Vec2& here) {
    const int under = pocket_under(geometry, here);
    return under >= 0 && is_inside(geometry.pockets[under], here) ? under : -1;
}

bool is_bed(const Table& table, const Pocket& pocket, const Vec2& here, double R) {
    if (table.bed) return is_inside(*table.bed, here);
    if (!(table.width > 0.0 && table.length > 0.0)) return true;  // it has no end
    const Vec2 c = pocket.center, low = table.corner, high = low + Vec2(table.width, table.length);
    if (is_inside(Rectangle(low.x(), low.y(), high.x(), high.y()), c)) return true;
    const Rectangle between_jaws(low.x() - R, low.y() - R, high.x() + R, high.y() + R);
    return is_inside(between_jaws, here) && dot(here - c, Vec2(0.5 * (low + high) - c)) > 0.0;
}

std::optional<double> climbs(double v_n, double sunk, double R, double gravity) {
    if (!(sunk < 1.0) || !(v_n > 0.0)) return std::nullopt;
    const double kept = (1.0 - sunk) * v_n, left = kept * kept - 2.0 * gravity * R * sunk;
    return left > 0.0 ? std::optional(std::sqrt(left)) : std::nullopt;
}

}  // namespace carom
