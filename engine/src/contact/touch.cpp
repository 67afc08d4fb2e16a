#include "contact/touch.h"

#include <algorithm>

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

bool beside(const Geometry& geometry, const Contact& contact, const BallAt& ball) {
    return contact.with == With::kNose ? beside(geometry.noses[contact.other], ball)
                                       : beside(geometry.cushions[contact.other], ball);
}

bool touches_part(const Geometry& geometry, const Contact& contact, const BallAt& ball) {
    if (touch_part(geometry, contact, ball).gap > kTouchTolerance) return false;
    const Vec2 here = planar(ball.r);
    if (contact.with == With::kNose)
        return beside(geometry.noses[contact.other], ball, end_rounding(here, 0.0));
    const CushionLine& line = geometry.cushions[contact.other];
    return between_ends(dot(line.direction, here - line.from), dot(line.direction, planar(ball.v)), 0.0,
                        line.length, end_rounding(here, line.length));
}

double part_height(const Geometry& geometry, const Contact& contact) {
    return contact.with == With::kNose ? geometry.noses[contact.other].height
                                       : geometry.cushions[contact.other].height;
}

double part_turn(const Geometry& geometry, const Contact& contact, double R) {
    return contact.with == With::kNose ? turn_around(geometry.noses[contact.other], R) : 0.0;
}

Vec2 part_place(const Geometry& geometry, const Contact& contact, const Vec2& r) {
    if (contact.with == With::kPocket) return geometry.pockets[contact.other].center;
    if (contact.with == With::kNose) return geometry.noses[contact.other].center;
    return nearest_point(geometry.cushions[contact.other], r);
}

}  // namespace carom
