// Queries of a record: states, orientations and the hash.
#include "carom/engine/record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "base/record_hash.h"
#include "carom/engine/math.h"
#include "carom/engine/next_scene.h"
#include "physics/motion.h"

namespace carom {

// name() and kind() look a type up by its number.
static_assert([] {
    for (int i = 0; i < kEventTypes; ++i)
        if (static_cast<int>(kEventKinds[i].type) != i) return false;
    return true;
}());

namespace {

// Returns the rotation by a vector (axis times angle).
Eigen::Quaterniond rotation(const Vec3& turn) {
    const double angle = std::sqrt(turn.x() * turn.x() + turn.y() * turn.y() + turn.z() * turn.z());
    if (angle == 0.0) return Eigen::Quaterniond::Identity();
    // A ball that spins for years turns farther than sin_cos can reduce; its orientation is then only
    // rounding.
    constexpr double kTwoTurns = 12.566370614359172;
    const auto [s, c] = sin_cos(0.5 * std::fmod(angle, kTwoTurns));
    const double k = s / angle;
    return {c, k * turn.x(), k * turn.y(), k * turn.z()};
}

// [rad] The largest angle of a step, and [-] the most steps for all balls together. A record with more
// rotation, which no shot has, is integrated in larger steps, to limit the work.
constexpr double kLargestStep = 0.2, kMostSteps = 1e6;

// Returns the number of steps of `largest_step` that follow w from w0 at the rate dw over `time`.
double step_count(const Vec3& w0, const Vec3& dw, double time, double largest_step) {
    const double steps = std::max(w0.norm(), (w0 + time * dw).norm()) * time / largest_step;
    return steps < kMostSteps ? steps : kMostSteps;
}

// Returns the rotation over `time` while w changes linearly from w0 at the rate dw.
Eigen::Quaterniond turned(const Vec3& w0, const Vec3& dw, double time, double largest_step) {
    const Vec3 swerve = w0.cross(dw);
    if (swerve == Vec3::Zero()) return rotation(w0 * time + 0.5 * time * time * dw);  // fixed axis
    // Magnus expansion to fourth order: Omega = h w_mid - h^3/12 w_mid x dw.
    // With steps of a fifth of a radian the error is 1e-7 rad over a shot.
    const int steps = 1 + static_cast<int>(step_count(w0, dw, time, largest_step));
    const double h = time / steps;
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
    for (int i = 0; i < steps; ++i) {
        const Vec3 middle = w0 + (i + 0.5) * h * dw;
        q = rotation(h * middle - h * h * h / 12.0 * middle.cross(dw)) * q;
    }
    return q.normalized();
}

// Returns the rotation of a segment over its first `tau` seconds. The decay of w_z ends at 0.
Eigen::Quaterniond segment_turn(const Segment& s, double tau, double largest_step) {
    if (!(tau > 0.0)) return Eigen::Quaterniond::Identity();
    const double sign = s.w.z() > 0.0 ? 1.0 : (s.w.z() < 0.0 ? -1.0 : 0.0);
    const Vec3 dw(s.dw.x(), s.dw.y(), -sign * s.spin_decay);
    const double spin_end = sign != 0.0 && s.spin_decay > 0.0 ? std::abs(s.w.z()) / s.spin_decay : 0.0;
    if (sign == 0.0 || s.spin_decay == 0.0 || tau <= spin_end) {
        return turned(s.w, sign == 0.0 ? Vec3(s.dw.x(), s.dw.y(), 0.0) : dw, tau, largest_step);
    }
    const Vec3 w_then(s.w.x() + spin_end * s.dw.x(), s.w.y() + spin_end * s.dw.y(), 0.0);
    return turned(w_then, Vec3(s.dw.x(), s.dw.y(), 0.0), tau - spin_end, largest_step) *
           turned(s.w, dw, spin_end, largest_step);
}

double largest_step_of(const std::vector<BallTrack>& tracks) {
    double steps = 0.0;
    for (const BallTrack& track : tracks) {
        for (std::size_t i = 0; i + 1 < track.segments.size(); ++i) {
            const Segment& s = track.segments[i];
            const Vec3 dw(s.dw.x(), s.dw.y(), 0.0);  // w_z only decays
            steps += step_count(s.w, dw, track.segments[i + 1].start - s.start, kLargestStep);
        }
    }
    return kLargestStep * std::max(1.0, steps / kMostSteps);
}

}  // namespace

// Orientation of every ball at the start of each of its segments.
struct Record::Orientations {
    std::once_flag once;
    double largest_step = kLargestStep;
    std::vector<std::vector<Eigen::Quaterniond>> at_start;
};

std::size_t BallTrack::segment_at(double t) const {
    const auto later = std::upper_bound(segments.begin(), segments.end(), t,
                                        [](double time, const Segment& s) { return time < s.start; });
    return later == segments.begin() ? 0 : static_cast<std::size_t>(later - segments.begin()) - 1;
}

Vec3 spin_at(const Segment& s, double tau, double R) {
    const double left = std::abs(s.w.z()) - s.spin_decay * tau;
    const double w_z = !(left > 0.0) ? 0.0 : (s.w.z() < 0.0 ? -left : left);
    if (s.state == MotionState::kRolling) {
        const Vec3 v = velocity_at(s, tau);
        return {-v.y() / R, v.x() / R, w_z};
    }
    return {s.w.x() + tau * s.dw.x(), s.w.y() + tau * s.dw.y(), w_z};
}

Record::Aside::Aside() : orientations(std::make_shared<Orientations>()) {}

void Record::clear() {
    for (BallTrack& track : tracks) {
        track.segments.clear();
        track.pocket = -1;
    }
    events.clear();
    clusters.clear();
    costs.clear();
    setup_detect_ns = duration = 0.0;
    stopped = StopReason::kAtRest;
    aside_ = Aside();
}

BallState Record::state_at(int ball, double t) const {
    const BallTrack& track = tracks[ball];
    t = std::clamp(t, 0.0, duration);
    const Segment& s = track.segments[track.segment_at(t)];
    const double tau = std::min(t - s.start, s.duration);
    BallState state;
    state.state = s.state;
    const double R = size(ball).R;
    const Placed placed = placed_at(s, tau, gravity, R);
    state.position = placed.position;
    state.velocity = placed.velocity;
    state.spin = tau < until_floor(s, R, gravity) ? spin_at(s, tau, R) : Vec3::Zero();
    state.pocket = s.state == MotionState::kPocketed ? track.pocket : -1;
    return state;
}

void Record::states_at(std::span<const double> times, double* rvw, std::uint8_t* kinds) const {
    for (const double t : times) {
        for (int ball = 0; ball < static_cast<int>(tracks.size()); ++ball) {
            const BallState s = state_at(ball, t);
            if (kinds != nullptr) *kinds++ = static_cast<std::uint8_t>(s.state);
            if (rvw == nullptr) continue;
            for (const Vec3* row : {&s.position, &s.velocity, &s.spin})
                rvw = std::copy_n(row->data(), 3, rvw);
        }
    }
}

Eigen::Quaterniond Record::orientation_at(int ball, double t) const {
    Orientations& made = *aside_.orientations;
    std::call_once(made.once, [this, &made] {
        const double largest_step = made.largest_step = largest_step_of(tracks);
        for (const BallTrack& track : tracks) {
            std::vector<Eigen::Quaterniond> starts;
            Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
            for (std::size_t i = 0; i < track.segments.size(); ++i) {
                starts.push_back(q);
                if (i + 1 < track.segments.size())
                    q = (segment_turn(track.segments[i],
                                      track.segments[i + 1].start - track.segments[i].start, largest_step) *
                         q)
                            .normalized();
            }
            made.at_start.push_back(std::move(starts));
        }
    });
    const BallTrack& track = tracks[ball];
    t = std::clamp(t, 0.0, duration);
    const std::size_t i = track.segment_at(t);
    const Segment& s = track.segments[i];
    const double turns = std::min(s.duration, until_floor(s, size(ball).R, gravity));
    return segment_turn(s, std::min(t - s.start, turns), made.largest_step) * made.at_start[ball][i];
}

bool same_balls(const Scene& scene, const Record& record) {
    return ids_of(scene.ball) == ids_of(record.tracks);
}

Scene scene_after(const Scene& scene, const Record& record) {
    if (!same_balls(scene, record))
        throw std::invalid_argument(
            "the scene and the record have different balls; pass the scene of the record");
    Scene after = scene;
    after.cue.reset();
    after.ball.clear();
    for (std::size_t i = 0; i < scene.ball.size(); ++i) {
        BallState end = record.state_at(static_cast<int>(i), record.duration);
        // If the record ends during a cluster, the next shot begins after it.
        if (end.state == MotionState::kColliding) {
            const Segment& freed = record.tracks[i].segments.back();
            end = {freed.state, freed.r, freed.v, freed.w};
        }
        if (is_gone(end.state)) continue;
        BallStart& ball = after.ball.emplace_back(scene.ball[i]);
        // A ball that is falling into a pocket starts its fall again.
        const double R = record.size(static_cast<int>(i)).R;
        const bool in_air = end.state == MotionState::kAirborne;
        ball.height = in_air ? std::max(0.0, end.position.z() - R) : 0.0;
        ball.position = {end.position.x(), end.position.y(), R + ball.height};
        ball.velocity = {end.velocity.x(), end.velocity.y(), in_air ? end.velocity.z() : 0.0};
        ball.spin = end.spin;
        ball.where = {};
    }
    return after;
}

std::string Record::hash() const {
    RecordHash hash;
    for (const BallTrack& track : tracks) {
        hash.ball(track.segments.size());
        for (const Segment& s : track.segments) hash.segment(s);
    }
    for (const Event& e : events) hash.event(e);
    hash.duration(duration);
    return fmt::format("{:016x}", hash.value());
}

std::string Record::partner_id(Partner partner, int number) const {
    if (number < 0 || partner == Partner::kNone) return "";
    const auto index = static_cast<std::size_t>(number);
    if (partner == Partner::kBall) return tracks[index].id;
    return with_parts(table, partner, [index](const auto& parts) { return parts[index].id; });
}

Scene next_scene(const Scene& scene, const Record& record, const Cue& cue) {
    Scene next = scene_after(scene, record);
    next.cue = cue;
    validate(next);
    return next;
}

}  // namespace carom
