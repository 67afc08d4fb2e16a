#include "record/gaps.h"

#include <cmath>
#include <limits>
#include <vector>

#include "carom/engine/tolerances.h"
#include "contact/detect.h"
#include "physics/motion.h"
#include "physics/nose_reach.h"
#include "physics/touch_tolerance.h"

namespace carom {

namespace {
constexpr double kFar = std::numeric_limits<double>::infinity();
}

double rounding_of(const Vec3& v, const Vec3& w, double R, double t) {
    return kClosingUlp * kEpsilon * (length3(v) + R * length3(w)) * t;
}

double allowed_depth(const SeenBall& ball) {
    return touch_tolerance(planar(ball.r)) + ball.rounding;
}

double allowed_depth(const SeenBall& ball, const Vec2& wall) {
    // Both coordinates are rounded, and so is the direction between them.
    return touch_tolerance(planar(ball.r).cwiseAbs() + wall.cwiseAbs()) + ball.rounding;
}

SeenBall see(const Record& record, std::size_t ball, std::size_t segment, const Vec3& r, double rounding,
             bool flights) {
    const std::vector<Segment>& segments = record.tracks[ball].segments;
    SeenBall seen{.r = r,
                  .R = record.size(static_cast<int>(ball)).R,
                  .flies = flies(segments[segment].state),
                  .rounding = rounding,
                  .disc = record.balls.discs()};
    if (!flights) return seen;
    const auto falls = [&](std::size_t k) { return segments[k].state == MotionState::kFalling; };
    std::size_t k = segment;
    if (falls(k)) {
        while (k > 0 && falls(k - 1)) --k;
        seen.fell = segments[k].start;
    }
    while (k > 0 && !flies(segments[k - 1].state)) --k;
    if (k > 0) seen.flew = segments[k].start;
    return seen;
}

double gap_between(const SeenBall& one, const SeenBall& two) {
    const bool in_space = one.flies || two.flies || one.flew >= two.fell || two.flew >= one.fell;
    if (!in_space) return length(planar(two.r) - planar(one.r)) - contact_distance(one.R, two.R, one.disc);
    return length3(two.r - one.r) - (one.R + two.R);
}

double gap_to(const CushionLine& line, const SeenBall& ball) {
    const Vec2 offset = planar(ball.r) - line.from;
    const double foot = dot(line.direction, offset), level = std::abs(cross(line.direction, offset));
    if (!(foot >= 0.0 && foot <= line.length)) return kFar;
    if (!ball.flies) return level - (ball.R - line.inset);
    return length(Vec2(level, ball.r.z() - line.height)) - nose_reach(ball.R, line.height, line.inset);
}

double gap_to(const Nose& nose, const SeenBall& ball) {
    const Vec2 out = planar(ball.r) - nose.center;
    const double level = nose.sign() * length(out) - nose.radius;
    // Behind an arc with ends a ball may be, and it does not touch it there.
    if (!nose.span.whole && (level < 0.0 || !nose.span.holds(out))) return kFar;
    if (!ball.flies) return level - (ball.R - nose.inset);
    if (level < 0.0) return kFar;
    return length(Vec2(level, ball.r.z() - nose.height)) - nose_reach(ball.R, nose.height, nose.inset);
}

double gap_to_cloth(const SeenBall& ball) {
    return ball.flies ? ball.r.z() - ball.R : 0.0;
}

}  // namespace carom
