#include "record/gaps.h"

#include <vector>

#include "carom/engine/tolerances.h"
#include "contact/detect.h"
#include "contact/touch.h"
#include "physics/motion.h"
#include "physics/touch_tolerance.h"

namespace carom {

namespace {

BallAt at(const SeenBall& ball) {
    return {ball.r, Vec3::Zero(), ball.R, ball.flies};
}

}  // namespace

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
                  .flies = is_aloft(segments[segment], record.size(static_cast<int>(ball)).R),
                  .rounding = rounding,
                  .disc = record.balls.discs()};
    if (!flights) return seen;
    const auto falls = [&](std::size_t k) { return segments[k].state == MotionState::kFalling; };
    std::size_t k = segment;
    if (falls(k)) {
        while (k > 0 && falls(k - 1)) --k;
        seen.fell = segments[k].start;
    }
    while (k > 0 && !is_aloft(segments[k - 1], seen.R)) --k;
    if (k > 0) seen.flew = segments[k].start;
    return seen;
}

bool in_space(const SeenBall& one, const SeenBall& two) {
    return one.flies || two.flies || one.flew >= two.fell || two.flew >= one.fell;
}

double gap_between(const SeenBall& one, const SeenBall& two) {
    return (in_space(one, two) ? touch_ball(at(one), at(two)) : touch_level(at(one), at(two), one.disc)).gap;
}

double gap_to(const CushionLine& line, const SeenBall& ball) {
    return beside(line, at(ball)) ? touch_part(line, at(ball)).gap : kNever;
}

double gap_to(const Nose& nose, const SeenBall& ball) {
    return beside(nose, at(ball)) ? touch_part(nose, at(ball)).gap : kNever;
}

double gap_to_cloth(const SeenBall& ball) {
    return ball.flies ? touch_cloth(at(ball)).gap : 0.0;
}

}  // namespace carom
