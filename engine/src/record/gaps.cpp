#include "record/gaps.h"

#include <cmath>
#include <limits>

#include "carom/engine/tolerances.h"
#include "contact/detect.h"
#include "physics/nose_reach.h"

namespace carom {

namespace {
constexpr double kFar = std::numeric_limits<double>::infinity();
}

double rounding_of(const Vec3& v, const Vec3& w, double R, double t) {
    return kClosingUlp * kEpsilon * (length3(v) + R * length3(w)) * t;
}

double allowed_depth(const SeenBall& ball) {
    return kTouchTolerance + ball.rounding;
}

double gap_between(const SeenBall& one, const SeenBall& two) {
    if (!one.flies && !two.flies)
        return length(planar(two.r) - planar(one.r)) - contact_distance(one.R, two.R);
    if (one.sinks || two.sinks) return kFar;
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
    const double level = length(planar(ball.r) - nose.center) - nose.radius;
    if (!ball.flies) return level - (ball.R - nose.inset);
    if (level < 0.0) return kFar;
    return length(Vec2(level, ball.r.z() - nose.height)) - nose_reach(ball.R, nose.height, nose.inset);
}

double gap_to_cloth(const SeenBall& ball) {
    return ball.flies ? ball.r.z() - ball.R : 0.0;
}

}  // namespace carom
