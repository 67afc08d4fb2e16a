#include "carom/render/draw_list.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "stage/overlay_lines.h"

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

/// The cue at time t [s], if it is drawn: before the strike at 0 it aims and draws back, then it follows
/// through and fades. A record does not contain the cue, so its aim, elevation and tip are derived from the
/// ball's first velocity and spin.
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

std::shared_ptr<const TableMesh> mesh_of(const Record& record, Edges edges) {
    TableMesh mesh = make_table_mesh(record.table, record.balls.R, visited_places(record), edges);
    if (record.render.cloth) mesh.cloth = color_of(*record.render.cloth).value_or(mesh.cloth);
    return std::make_shared<const TableMesh>(std::move(mesh));
}

// [s] How long a pocketed ball is shown sinking.
constexpr double kSinkTime = 0.15;

// The position of a ball that was pocketed at `when`, sinking from where it was to where it lies.
Vec3 sinking_place(const Record& record, int ball, double when, double t, const Vec3& rest) {
    constexpr double kGravity = 9.81;  // [m/s^2] only for the look
    const double age = t - when;
    if (age >= kSinkTime || when <= 0.0) return rest;
    const BallState before = record.state_at(ball, std::nextafter(when, -1.0));
    const double left = 1.0 - age / kSinkTime;
    Vec3 place = rest + left * left * (before.position - rest);
    place.z() = std::max(rest.z(), before.position.z() + std::min(before.velocity.z(), 0.0) * age -
                                       0.5 * kGravity * age * age);
    return place;
}

// Whether a later ball in the same pocket hides this one: only the last ball in each pocket is shown.
bool is_covered(const Record& record, std::size_t ball, double t) {
    const auto arrival = [&](std::size_t i) {
        const Segment& last = record.tracks[i].segments.back();
        return last.state == MotionState::kPocketed ? last.start : -1.0;
    };
    const int pocket = record.tracks[ball].pocket;
    for (std::size_t other = 0; other < record.tracks.size(); ++other) {
        if (other == ball || record.tracks[other].pocket != pocket) continue;
        const double when = arrival(other), mine = arrival(ball);
        if (when >= 0.0 && (when <= 0.0 || when + kSinkTime <= t) &&
            (when > mine || (when == mine && other > ball)))
            return true;
    }
    return false;
}

// Smaller pixels need fewer samples: from 1920x1080 on their number in the whole picture stays the same.
int samples_of(const StageOptions& options) {
    constexpr double kFull = 1920.0 * 1080.0;
    constexpr int kLeast = 4;
    const double share = std::min(1.0, kFull / (double(options.size.width) * options.size.height));
    const int scaled = static_cast<int>(std::lround(share * options.table_samples));
    return std::clamp(scaled, std::min(kLeast, options.table_samples), options.table_samples);
}

}  // namespace

Stage::Stage(const Record& record, const StageOptions& options)
    : record_(record),
      options_(options),
      table_(
          mesh_of(record, CameraPath::moves(options.camera, options.view) ? Edges::kSharp : Edges::kRounded)),
      camera_(record, *table_, options.camera, options.view, options.size) {
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        styles_.push_back(ball_style(record.tracks[i].id, record.table.preset, static_cast<int>(i)));
    }
}

DrawList Stage::at(double t, std::optional<FrameBudget> cost) const {
    DrawList list;
    list.table = table_;
    list.camera = camera_.at(t);
    list.table_samples = samples_of(options_);
    list.camera_moves = list.less_detail = camera_.moves();
    for (std::size_t i = 0; i < record_.tracks.size(); ++i) {
        const BallState state = record_.state_at(static_cast<int>(i), t);
        if (!state.position.allFinite()) continue;
        // A ball that has left the table falls out of sight.
        if (state.state == MotionState::kOut && state.position.z() < 0.0) continue;
        DrawBall ball;
        ball.in_pocket = state.state == MotionState::kPocketed;
        if (ball.in_pocket && is_covered(record_, i, t)) continue;
        ball.center = ball.in_pocket
                          ? sinking_place(record_, static_cast<int>(i),
                                          record_.tracks[i].segments.back().start, t, state.position)
                          : state.position;
        ball.orientation = record_.orientation_at(static_cast<int>(i), t);
        // The radius is at least two pixels: on a cloth of kilometres the balls would otherwise be invisible.
        ball.radius = std::max(record_.size(static_cast<int>(i)).R,
                               2.0 / std::max(list.camera.scale(state.position), 1e-12));
        ball.style = styles_[i];
        list.balls.push_back(ball);
    }
    if (!record_.render.hides_cue) list.cue = cue_at(record_, *table_, t);
    add_overlay(list, record_, options_.overlay, t, cost);
    return list;
}

}  // namespace carom::render
