#include "stage/cue_stroke.h"

#include <algorithm>
#include <cmath>

namespace carom::render {

namespace {

constexpr double kLength = 1.47;  // [m]
// [s] The ends of aiming, of the draw back and of the follow-through; then the cue is removed.
constexpr double kAims = -1.1, kBack = -0.3, kFollows = 0.06, kFades = 0.14, kGone = 0.2;
constexpr double kAway = 60.0;                      // [m/s^2]
constexpr double kDrawnBack = 0.16, kNear = 0.015;  // [m] of the tip from the ball
constexpr double kLowest = 0.055, kHighest = 1.3;   // [rad] elevation

// [m] Distance of the tip behind the place where it meets a ball that gets this speed.
double drawn_back(double t, double speed) {
    const auto smooth = [](double x) { return x * x * (3.0 - 2.0 * x); };
    if (t < kBack)
        return kNear + (kDrawnBack - kNear) * smooth(std::clamp((t - kAims) / (kBack - kAims), 0.0, 1.0));
    if (t < 0.0) return kDrawnBack * (1.0 - std::pow(1.0 - t / kBack, 3.0));
    const double follow = std::min(0.06 + 0.03 * speed, 0.2);
    const double away = std::max(t - kFollows, 0.0);
    return follow * std::expm1(-0.5 * speed * t / follow) + 0.5 * kAway * away * away;
}

// [rad] To clear the rail behind the ball.
double least_elevation(const TableMesh& table, const Vec3& place, const Vec2& aim) {
    double behind = 1e9;
    for (int i = 0; i < 2; ++i) {
        const double room = aim[i] > 0.0 ? place[i] - table.inner_low[i] : table.inner_high[i] - place[i];
        if (aim[i] != 0.0) behind = std::min(behind, std::max(room, 0.0) / std::abs(aim[i]));
    }
    return std::atan2(table.wood_top + 0.02 - place.z(), behind + 0.02);
}

}  // namespace

std::optional<DrawCue> cue_at(const Record& record, const TableMesh& table, double t) {
    if (record.events.empty() || record.events[0].type != EventType::kCueStrike ||
        record.events[0].time != 0.0 || t >= kGone)
        return std::nullopt;
    const int ball = record.events[0].a;
    const BallState struck = record.state_at(ball, 0.0);
    const double R = record.size(ball).R, speed = struck.velocity.head<2>().norm();
    if (!(speed > 1e-3)) return std::nullopt;
    const Vec3 forward(struck.velocity.x() / speed, struck.velocity.y() / speed, 0.0),
        left(-forward.y(), forward.x(), 0.0);
    // A tip at the offset c [radii] gives the spin 5/2 c x v / R.
    const auto offset = [&](double spin) { return std::clamp(0.4 * R * spin / speed, -0.6, 0.6); };
    const double side = -offset(struck.spin.z()), height = offset(struck.spin.dot(left));
    // A raised cue tilts the axis of the side spin, and lifts the ball.
    const double masse = std::abs(side) > 0.05 ? std::abs(struck.spin.dot(forward) / struck.spin.z()) : 0.0;
    const double raised = std::max(std::atan(masse), std::atan2(2.0 * struck.velocity.z(), speed));
    const double elevation = std::clamp(
        std::max(raised, least_elevation(table, struck.position, forward.head<2>())), kLowest, kHighest);
    // A raised cue is removed at once, so that it does not meet the ball again.
    constexpr double kRaised = 0.35, kSooner = 4.0;
    const double after = t > 0.0 && elevation > kRaised ? kSooner * t : t;
    if (after >= kGone) return std::nullopt;
    const double c = std::cos(elevation), s = std::sin(elevation);
    const Vec3 along(c * forward.x(), c * forward.y(), -s), up(s * forward.x(), s * forward.y(), c);
    const double deep = std::sqrt(std::max(1.0 - side * side - height * height, 0.0));
    DrawCue cue;
    cue.tip =
        struck.position + R * (side * left + height * up - deep * along) - drawn_back(after, speed) * along;
    cue.butt = cue.tip - kLength * along;
    cue.opacity = static_cast<float>(std::min(1.0, (kGone - after) / (kGone - kFades)));
    return cue;
}

}  // namespace carom::render
