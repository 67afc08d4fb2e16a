#include "validate/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/vec.h"

namespace carom::tools {
namespace {

int index_of(const Record& record, const std::string& id) {
    for (std::size_t i = 0; i < record.tracks.size(); ++i)
        if (record.tracks[i].id == id) return static_cast<int>(i);
    throw std::runtime_error(fmt::format("there is no ball {}", id));
}

bool involves(const Record& record, const Event& event, int ball) {
    bool hit = event.a == ball && event.type != EventType::kBallCluster;
    each_hit(event, record.hits(event),
             [&](const Hit& h) { hit = hit || h.a == ball || (h.b == ball && h.partner == Partner::kBall); });
    return hit;
}

/// The time of the ball's first impact accepted by `matters`.
template <class Matters>
std::optional<double> first_impact(const Record& record, int ball, const Matters& matters) {
    for (const Event& e : record.events)
        if (kind(e.type).phase == EventPhase::kImpact && matters(e.type) && involves(record, e, ball))
            return e.time;
    return std::nullopt;
}

std::optional<double> first_impact(const Record& record, int ball) {
    return first_impact(record, ball, [](EventType) { return true; });
}

/// When the ball rolls, at or after its first impact.
std::optional<double> rolls(const Record& record, int ball) {
    const double from = first_impact(record, ball).value_or(0.0);
    for (const Segment& s : record.tracks[ball].segments)
        if (s.start >= from && record.state_at(ball, s.start).state == MotionState::kRolling) return s.start;
    return std::nullopt;
}

std::optional<double> instant(const Record& record, int ball, Instant when) {
    switch (when) {
        case Instant::kStart:
            return 0.0;
        case Instant::kHit:
            return first_impact(record, ball, balls_collide);
        case Instant::kCushion:
            return first_impact(record, ball, [](EventType type) { return type == EventType::kBallCushion; });
        case Instant::kRolled:
            return rolls(record, ball);
        case Instant::kRest:
            if (record.stopped == StopReason::kAtRest) return record.duration;
    }
    return std::nullopt;
}

/// The speed just before the ball's first impact, or at the start if it has none.
double speed_before(const Record& record, int ball) {
    const double impact = first_impact(record, ball).value_or(0.0);
    return record.state_at(ball, std::nextafter(impact, -1.0)).velocity.norm();
}

double deceleration(const Record& record, int ball, double time) {
    Vec2 a = Vec2::Zero();
    for (const Segment& s : record.tracks[ball].segments)
        if (s.start <= time) a = s.a;
    return a.norm();
}

}  // namespace

double measure(const Record& record, const Measured& what) {
    const int ball = index_of(record, what.ball);
    const std::optional<double> from = instant(record, ball, what.when);
    const double time = from.value_or(0.0) + what.after;
    if (!from || (time > record.duration && record.stopped != StopReason::kAtRest))
        throw std::runtime_error(fmt::format("ball {} has no instant {} + {} s within {} s", what.ball,
                                             kInstants[static_cast<int>(what.when)], what.after,
                                             record.duration));
    const BallState state = record.state_at(ball, time);
    const Vec2 place = state.position.head<2>();
    const Vec3& v = state.velocity;
    switch (what.quantity) {
        case Quantity::kSpeed:
            return v.norm();
        case Quantity::kSpeedRatio:
            return v.norm() / speed_before(record, ball);
        case Quantity::kVelocityX:
            return v.x();
        case Quantity::kVelocityY:
            return v.y();
        case Quantity::kDirection:
            return std::atan2(v.y(), v.x()) * 180.0 / std::numbers::pi;
        case Quantity::kDeceleration:
            return deceleration(record, ball, time);
        case Quantity::kPlace:
            return (place - what.place).norm();
        case Quantity::kWay:
            return (place - record.state_at(ball, 0.0).position.head<2>()).norm();
        case Quantity::kTime:
            return time;
        case Quantity::kShare:
        case Quantity::kMean:
            break;
    }
    return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace carom::tools
