#include "record/verify_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "contact/detect.h"
#include "physics/motion.h"

namespace carom {
namespace {

// [m/s^2] Smaller accelerations are rounding.
constexpr double kNoRate = 1e-15;
// [ulp of a speed] Rounding of its change in an interval of a resting contact.
constexpr double kHeldUlp = 4.0;

class Motions {
  public:
    Motions(const Record& record, const Plan& plan) : record_(record), plan_(plan) {}

    std::optional<Violation> order() {
        for (ball_ = 0; ball_ < record_.tracks.size() && !found_; ++ball_) check_order();
        for (std::size_t k = 1; k < record_.events.size() && !found_; ++k)
            if (record_.events[k].time < record_.events[k - 1].time)
                found_ = Violation{k, "U2",
                                   fmt::format("time falls from {:.17g} to {:.17g} s",
                                               record_.events[k - 1].time, record_.events[k].time)};
        return found_;
    }

    std::optional<Violation> end() {
        check_end();
        return found_;
    }

  private:
    const BallTrack& track(std::size_t ball) const { return record_.tracks[ball]; }
    const std::string& id(std::size_t ball) const { return track(ball).id; }

    template <class... Values>
    void report(const char* law, fmt::format_string<Values...> message, Values&&... values) {
        if (!found_)
            found_ =
                Violation{record_.events.size(), law, fmt::format(message, std::forward<Values>(values)...)};
    }

    void check_order() {
        const std::vector<Segment>& segments = track(ball_).segments;
        if (segments.empty() || segments[0].start != 0.0)
            return report("U2", "the motion of ball {} does not begin at 0 s", id(ball_));
        for (std::size_t k = 0; k < segments.size() && !found_; ++k) {
            const Segment& s = segments[k];
            const bool last = k + 1 == segments.size();
            const double end = s.start + s.duration, next = last ? record_.duration : segments[k + 1].start;
            if (!last && next < s.start)
                report("U2", "a motion of ball {} begins before the one that precedes it, at {:.17g} s",
                       id(ball_), s.start);
            const bool collides = s.state == MotionState::kColliding;
            if (collides && (k == 0 || last))
                report("U6", "ball {} collides at {:.17g} s without a motion before or after it", id(ball_),
                       s.start);
            if (s.start > record_.duration && (k == 0 || segments[k - 1].state != MotionState::kColliding))
                report("U8", "a motion of ball {} begins at {:.17g} s, after the end", id(ball_), s.start);
            if (next > end + same_time(next))
                report("U7", "ball {} is {} until {:.17g} s, although that ends at {:.17g} s", id(ball_),
                       name(s.state), next, end);
            if (!found_) check_motion(s);
        }
    }

    // The accelerations, decays and durations that follow from the state, the frictions and gravity.
    void check_motion(const Segment& s) {
        const MotionParams& p = plan_.motion[ball_];
        const double speed = length(planar(s.v)), spin = length3(s.w), g = p.gravity;
        const Vec2 u = cloth_slip(s.v, s.w, p.R);
        const double slip = length(u), same = kSameShare * (speed + p.R * spin);
        Vec2 a = Vec2::Zero(), dw = a;
        double duration = s.duration, decay = 0.0;
        bool moves_so = true;
        const bool flat = s.v.z() == 0.0;
        switch (s.state) {
            case MotionState::kStationary:
                moves_so = speed == 0.0 && spin == 0.0;
                duration = s.held ? duration : kNever;
                break;
            case MotionState::kPocketed:
                moves_so = speed == 0.0 && spin == 0.0 && flat;
                break;
            case MotionState::kSpinning:
                moves_so = speed == 0.0 && length(planar(s.w)) == 0.0 && spin > 0.0;
                if (p.spin_decay && p.spin > 0.0) duration = spin / p.spin;
                break;
            case MotionState::kSliding:
                if (!p.sliding || p.slide == 0.0) {
                    duration = kNever;
                } else if (!p.rolls) {
                    a = planar(s.v) * (-p.slide / speed);
                    duration = speed / p.slide;
                } else {
                    a = u * (-p.slide / slip);
                    dw = Vec2(a.y(), -a.x()) * (2.5 / p.R);
                    duration = 2.0 / 7.0 * slip / p.slide;
                }
                moves_so = (p.rolls ? slip : speed) > 0.0 || s.held;
                break;
            case MotionState::kRolling:
                // In a resting contact it may begin at rest.
                moves_so = slip <= same && (speed > 0.0 || s.held);
                duration = p.rolling && p.roll > 0.0 ? speed / p.roll : kNever;
                if (duration < kNever) a = planar(s.v) * (-p.roll / speed);
                dw = Vec2(-a.y(), a.x()) / p.R;
                break;
            case MotionState::kFalling:
                duration = std::max(0.0, (std::sqrt(2.0 * g * s.r.z()) + s.v.z()) / g);
                break;
            case MotionState::kAirborne:
                // The height after it is R.
                moves_so = !(s.r.z() < p.R - kSamePlace) && plan_.in_force(Effect::kAirborne);
                duration =
                    g > 0.0
                        ? (s.v.z() + std::sqrt(s.v.z() * s.v.z() + 2.0 * g * std::max(0.0, s.r.z() - p.R))) /
                              g
                        : duration;
                break;
            case MotionState::kOut:
            case MotionState::kColliding:
                break;
        }
        const bool spins = !is_off_cloth(s.state) && !is_gone(s.state) &&
                           s.state != MotionState::kColliding && s.w.z() != 0.0;
        if (spins && p.spin_decay) decay = p.spin;
        // In a cluster balls may rise.
        const bool rises = s.state == MotionState::kColliding && plan_.in_force(Effect::kAirborne);
        const bool lies = !is_off_cloth(s.state) && !is_gone(s.state) && !rises;
        if (lies && (!flat || std::abs(s.r.z() - p.R) > kSamePlace)) moves_so = false;
        if (!moves_so)
            return report("U7", "ball {} is {} at {:.17g} s, which its place, velocity or spin contradicts",
                          id(ball_), name(s.state), s.start);
        if (s.held) {
            // Contacts accelerate it, too.
            a = s.a, dw = s.dw, duration = s.duration;
            if (s.state == MotionState::kRolling) dw = Vec2(-a.y(), a.x()) / p.R;
        }
        const double off = length(s.a - a) + p.R * length(s.dw - dw) + p.R * std::abs(s.spin_decay - decay);
        const double rates = length(a) + p.R * length(dw) + p.R * decay;
        // Contacts change velocities over the interval, and those are rounded.
        const double speeds = length3(s.v) + p.R * length3(s.w),
                     rounding = s.held ? kHeldUlp * kEpsilon * speeds / s.duration : 0.0;
        if (off > kSameShare * rates + kNoRate + rounding)
            report("U7", "the acceleration of ball {} ({}) at {:.17g} s is off by {:.3g} m/s^2", id(ball_),
                   name(s.state), s.start, off);
        const bool same_duration = s.duration == duration || std::abs(s.duration - duration) <=
                                                                 same_time(s.start) + kSameShare * duration;
        if (!same_duration)
            report("U7", "ball {} is {} for {:.17g} s from {:.17g} s on, but the laws give {:.17g} s",
                   id(ball_), name(s.state), s.duration, s.start, duration);
    }

    void check_end() {
        double last = !record_.events.empty() ? record_.events.back().time : 0.0;
        bool rests = true, moves = false;
        for (std::size_t ball = 0; ball < record_.tracks.size(); ++ball) {
            const BallTrack& of = track(ball);
            const Segment& s = of.segments[of.segment_at(record_.duration)];
            const bool lies = s.state == MotionState::kStationary || is_gone(s.state);
            last = std::max(last, s.start);
            if (!lies && record_.stopped == StopReason::kAtRest)
                report("U8", "ball {} has not come to rest", of.id);
            rests = rests && lies;
            moves = moves || (s.held && s.duration < kNever);
            int pocket = -1;
            for (const Event& e : record_.events)
                if (e.type == EventType::kBallPocket && static_cast<std::size_t>(e.a) == ball) pocket = e.b;
            if (of.pocket != pocket || (pocket >= 0) != (of.segments.back().state == MotionState::kPocketed))
                report("U8", "the pocket of ball {} differs from its events", of.id);
        }
        const auto& stop = plan_.scene.stop.time;
        if (record_.stopped != StopReason::kTime && std::abs(record_.duration - last) > same_time(last))
            report("U8", "the record ends at {:.17g} s, but its last change is at {:.17g} s",
                   record_.duration, last);
        else if (record_.stopped == StopReason::kTime && rests && !moves)
            report("U8", "everything is at rest, but the record says that it stopped at a time");
        else if (record_.stopped == StopReason::kEndless && rests)
            report("U8", "everything is at rest, but the record says that it never ends");
        else if (record_.stopped == StopReason::kTime && stop && record_.duration > *stop + same_time(*stop))
            report("U8", "the record ends at {:.17g} s, after the scene's end", record_.duration);
    }

    const Record& record_;
    const Plan& plan_;
    std::size_t ball_ = 0;
    std::optional<Violation> found_;
};

}  // namespace

std::optional<Violation> verify_motion(const Record& record, const Plan& plan) {
    return Motions(record, plan).order();
}

std::optional<Violation> verify_end(const Record& record, const Plan& plan) {
    return Motions(record, plan).end();
}

}  // namespace carom
