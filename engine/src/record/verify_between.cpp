#include "record/verify_between.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/airborne.h"
#include "carom/engine/tolerances.h"
#include "contact/roots.h"
#include "contact/touch.h"
#include "physics/motion.h"
#include "physics/nose_reach.h"
#include "record/gaps.h"

namespace carom {
namespace {

// [-] Points at which a piece of motion is checked, besides its start.
constexpr double kShares[] = {0.25, 0.5, 0.75};
// [m] A centre that crosses a cushion this close to its end may be rolling around it.
constexpr double kCrossingEnd = 1e-9;
// [-] A flight that ends this near to a cushion's line ended at it: the ball is out.
constexpr double kBeforeEnd = 1.0 - 1e-9;

/// A ball in the present piece of motion.
struct Piece {
    std::size_t segment = 0;
    bool begins = false, moves = false, pocketed = false;
    Vec2 r;               ///< [m] at the start
    double reach = 0.0;   ///< [m] longest possible path in this piece
    double energy = 0.0;  ///< [J/kg] at the start
};

class Between {
  public:
    Between(const Record& record, const Plan& plan, bool energy)
        : record_(record),
          plan_(plan),
          keeps_energy_(energy),
          rounding_(height_rounding(record)),
          pieces_(record.tracks.size()) {}

    std::optional<Violation> run() {
        for (const BallTrack& track : record_.tracks)
            for (const Segment& s : track.segments) times_.push_back(s.start);
        times_.push_back(record_.duration);
        std::sort(times_.begin(), times_.end());
        times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
        for (std::size_t k = 0; k + 1 < times_.size() && !found_; ++k) look(times_[k], times_[k + 1]);
        return found_;
    }

  private:
    double R(std::size_t ball) const { return record_.size(static_cast<int>(ball)).R; }
    const std::string& id(std::size_t ball) const { return record_.tracks[ball].id; }
    const Segment& segment(std::size_t ball) const {
        return record_.tracks[ball].segments[pieces_[ball].segment];
    }

    template <class... Values>
    void report(const char* law, double t, fmt::format_string<Values...> message, Values&&... values) {
        if (found_) return;
        std::size_t event = 0;
        while (event < record_.events.size() && record_.events[event].time <= t) ++event;
        found_ = Violation{event, law,
                           fmt::format(message, std::forward<Values>(values)...) +
                               fmt::format(", {:.17g} s after the start, between two events", t)};
    }

    Vec2 place(std::size_t ball, double t) const {
        const Segment& s = segment(ball);
        return pieces_[ball].moves ? planar(position_at(s, std::min(t - s.start, s.duration)))
                                   : pieces_[ball].r;
    }

    SeenBall seen(std::size_t ball, double t) const {
        const Segment& s = segment(ball);
        const Vec2 r = place(ball, t);
        const double tau = std::min(t - s.start, s.duration);
        const double z = placed_at(s, tau, record_.gravity).position.z();
        return see(record_, ball, pieces_[ball].segment, {r.x(), r.y(), z},
                   rounding_of(velocity_at(s, tau), s.w, R(ball), t), plan_.in_force(Effect::kAirborne));
    }

    double energy(std::size_t ball, double t) const {
        const Segment& s = segment(ball);
        if (s.state == MotionState::kColliding && s.start == t)
            return ball_energy(record_, static_cast<int>(ball), entering(record_, ball, s));
        const double tau = std::min(t - s.start, s.duration);
        const Placed placed = placed_at(s, tau, record_.gravity);
        BallState state;
        state.state = s.state;
        state.position = placed.position;
        state.velocity = placed.velocity;
        state.spin = spin_at(s, tau, R(ball));
        return ball_energy(record_, static_cast<int>(ball), state);
    }

    // [J/kg] One slow contact of every ball, at the speed for the largest.
    double slow_contacts() const {
        double masses = 0.0, parting = 0.0;
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            masses += record_.size(static_cast<int>(i)).m / record_.balls.m;
            parting = std::max(parting, parting_speed(R(i), record_.gravity));
        }
        return masses * parting * parting;
    }

    void look(double from, double to) {
        for (std::size_t i = 0; i < pieces_.size(); ++i) begin(i, from, to - from);
        check_energy(from, to);
        for (std::size_t i = 0; i < pieces_.size() && !found_; ++i) {
            if (pieces_[i].pocketed) continue;
            for (std::size_t j = 0; j < i; ++j) check_pair(j, i, from, to);
            if (pieces_[i].moves || pieces_[i].begins) check_table(i, from, to);
        }
    }

    void begin(std::size_t ball, double from, double duration) {
        const std::vector<Segment>& segments = record_.tracks[ball].segments;
        Piece& piece = pieces_[ball];
        const bool first = from == times_.front();
        const std::size_t before = piece.segment;
        while (piece.segment + 1 < segments.size() && segments[piece.segment + 1].start <= from)
            ++piece.segment;
        const Segment& s = segments[piece.segment];
        piece.pocketed = is_gone(s.state);
        const bool still = s.state == MotionState::kStationary || piece.pocketed;
        piece.moves = translates(s.state);
        piece.begins = first || before != piece.segment;
        if (piece.begins || !still) piece.energy = energy(ball, from);
        const double tau = std::min(from - s.start, s.duration);
        piece.r = planar(position_at(s, tau));
        piece.reach = piece.moves
                          ? duration * (length(planar(velocity_at(s, tau))) + 0.5 * duration * length(s.a))
                          : 0.0;
    }

    void check_energy(double from, double to) {
        if (!keeps_energy_) return;
        // During a cluster the contacts store energy, too.
        bool begins = false;
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            if (segment(i).state != MotionState::kColliding) continue;
            if (segment(i).start < from) return;
            begins = true;
        }
        double start = 0.0, middle = 0.0;
        const double half = from + 0.5 * (to - from);
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            start += pieces_[i].energy;
            const MotionState state = segment(i).state;
            const bool still = state == MotionState::kStationary || is_gone(state);
            middle += still ? pieces_[i].energy : energy(i, half);
        }
        start += chord_energy(record_, from);
        middle += chord_energy(record_, half);
        if (from == times_.front()) first_energy_ = last_energy_ = start;
        // At the start, allow for energy added by slow contacts of flying balls; each of them is checked at
        // its event.
        double added = plan_.in_force(Effect::kAirborne) ? slow_contacts() : 0.0;
        for (const auto& [t, now] : {std::pair{from, start}, std::pair{half, middle}}) {
            if (now > last_energy_ + 1e-12 * first_energy_ + rounding_ + std::exchange(added, 0.0))
                report("U4", t, "energy rises from {:.17g} to {:.17g} J/kg", last_energy_, now);
            last_energy_ = now;
            if (begins) break;
        }
    }

    void check_pair(std::size_t i, std::size_t j, double from, double to) {
        if (pieces_[i].pocketed || !(pieces_[i].moves || pieces_[j].moves)) return;
        const double touching = R(i) + R(j);
        const Vec2 apart = pieces_[j].r - pieces_[i].r;
        const double near = touching + pieces_[i].reach + pieces_[j].reach;
        if (dot(apart, apart) > near * near) return;
        for (const double share : kShares) {
            const double t = from + share * (to - from);
            const SeenBall one = seen(i, t), other = seen(j, t);
            const double gap = gap_between(one, other);
            if (gap < -allowed_depth(one) - other.rounding && !share_cluster(record_, i, j, t))
                report("U3", t, "balls {} and {} overlap by {:.3g} m", id(i), id(j), -gap);
        }
    }

    void check_table(std::size_t ball, double from, double to) {
        const double near = kNoseReach * R(ball) + pieces_[ball].reach;
        const bool in_air = flies(segment(ball).state);
        // With a bed there is cloth on both sides of a cushion.
        const bool may_cross = in_air && plan_.scene.table.bed;
        for (const CushionLine& line : plan_.geometry.cushions) {
            if (std::abs(in_frame(line, pieces_[ball].r - line.from).y()) > near) continue;
            if (!may_cross) check_crossing(ball, line, from, to);
            for (const double share : kShares) {
                const double t = from + share * (to - from);
                const SeenBall there = seen(ball, t);
                const double gap = gap_to(line, there);
                if (gap < -allowed_depth(there, line.from))
                    report("U3", t, "ball {} is {:.3g} m deep in a cushion", id(ball), -gap);
            }
        }
        for (const Nose& nose : plan_.geometry.noses) {
            const Vec2 apart = pieces_[ball].r - nose.center;
            const double far = near + std::abs(nose.radius);
            if (dot(apart, apart) > far * far) continue;
            if (nose.is_arc() && !in_air) check_passing(ball, nose, from, to);
            for (const double share : kShares) {
                const double t = from + share * (to - from);
                const SeenBall there = seen(ball, t);
                const double gap = gap_to(nose, there);
                if (gap < -allowed_depth(there, nose.center))
                    report("U3", t, "ball {} is {:.3g} m deep in a jaw or cushion end", id(ball), -gap);
                // It would land inside the jaw.
                const double over = nose.radius - length(planar(there.r) - nose.center);
                if (in_air && over > allowed_depth(there, nose.center))
                    report("U3", t, "ball {} flies on {:.3g} m behind the nose of a jaw", id(ball), over);
            }
        }
    }

    // A fast ball may pass through a cushion between two checks; a ball that flies over it is out.
    void check_crossing(std::size_t ball, const CushionLine& line, double from, double to) {
        const Segment& s = segment(ball);
        const double tau = std::min(from - s.start, s.duration),
                     duration = std::min(to - s.start, s.duration) - tau;
        const Vec2 r = in_frame(line, pieces_[ball].r - line.from),
                   v = in_frame(line, planar(velocity_at(s, tau))), a = in_frame(line, s.a);
        const double side = r.y() < 0.0 ? -1.0 : 1.0;
        const bool flew = flies(s.state);
        if (flew && !(std::abs(r.y()) > kCrossingEnd)) return;
        const double t = first_descent_quadratic(side * r.y(), side * v.y(), side * a.y(), duration);
        if (!(flew ? t < kBeforeEnd * duration : t <= duration)) return;
        const double foot = r.x() + t * (v.x() + 0.5 * t * a.x());
        if (foot > kCrossingEnd && foot < line.length - kCrossingEnd)
            report("U3", from + t, "ball {} {} a cushion", id(ball),
                   flew ? "flies on behind" : "passes through");
    }

    // The same for a round wall, from the side on which it acts: no other check would notice a passage behind
    // an open arc. Bisects between the points of the piece, and so shares no formula with the detector.
    void check_passing(std::size_t ball, const Nose& nose, double from, double to) {
        const auto out = [&](double t) { return Vec2(place(ball, t) - nose.center); };
        const auto in_front = [&](double t) { return nose.sign() * length(out(t)) > nose.radius; };
        double before = from;
        for (const double share : {0.25, 0.5, 0.75, 1.0}) {
            double low = before, high = before = from + share * (to - from);
            if (!in_front(low) || in_front(high)) continue;
            for (double middle; middle = low + 0.5 * (high - low), middle > low && middle < high;)
                (in_front(middle) ? low : high) = middle;
            if (nose.span.holds(out(high), -kCrossingEnd))
                report("U3", high, "ball {} passes through a round wall", id(ball));
        }
    }

    const Record& record_;
    const Plan& plan_;
    const bool keeps_energy_;
    const double rounding_;  // [J/kg]
    std::vector<Piece> pieces_;
    std::vector<double> times_;  // at which a segment begins
    double first_energy_ = 0.0, last_energy_ = 0.0;
    std::optional<Violation> found_;
};

}  // namespace

BallState entering(const Record& record, std::size_t ball, const Segment& colliding) {
    const Segment& before = *(&colliding - 1);
    const double tau = std::min(colliding.start - before.start, before.duration);
    const Placed placed = placed_at(before, tau, record.gravity);
    const double R = record.size(static_cast<int>(ball)).R;
    return {before.state, placed.position, placed.velocity, spin_at(before, tau, R)};
}

bool share_cluster(const Record& record, std::size_t one, std::size_t other, double t) {
    const auto any = [&](std::size_t ball, const auto& matches) {
        const BallTrack& track = record.tracks[ball];
        // Backwards, because the cluster is nearly always the last of the ball's segments.
        for (std::size_t k = track.segment_at(t) + 1; k-- > 0;) {
            const Segment& s = track.segments[k];
            if (s.state == MotionState::kColliding && t < s.start + s.duration && matches(s)) return true;
        }
        return false;
    };
    return any(one, [&](const Segment& a) {
        return any(other, [&](const Segment& b) { return a.start == b.start; });
    });
}

double ball_energy(const Record& record, int ball, const BallState& state) {
    if (is_gone(state.state)) return 0.0;
    const BallSize size = record.size(ball);
    const double fallen = is_off_cloth(state.state) ? record.gravity * (state.position.z() - size.R) : 0.0;
    return size.m / record.balls.m * (kinetic_energy(state.velocity, state.spin, size.R) + fallen);
}

double chord_energy(const Record& record, double t) {
    double sum = 0.0;
    const std::vector<Jaw>& jaws = record.table.jaws;
    if (std::none_of(jaws.begin(), jaws.end(), [](const Jaw& jaw) { return jaw.is_arc(); })) return sum;
    for (const BallTrack& track : record.tracks) {
        const Segment& s = track.segments[track.segment_at(t)];
        const double tau = t - s.start;
        if (!s.held || !(tau < s.duration)) continue;
        const BallSize size = track.own.value_or(record.balls.size());
        sum += size.m / record.balls.m * tau * (s.duration - tau) * kinetic_energy(s.a, s.dw, size.R);
    }
    return sum;
}

double height_rounding(const Record& record) {
    double sum = 0.0;
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        const BallSize size = record.size(static_cast<int>(i));
        sum += size.m / record.balls.m * size.R;
    }
    return 0x1p-49 * record.gravity * sum;
}

std::optional<Violation> verify_between(const Record& record, const Plan& plan, bool energy) {
    return Between(record, plan, energy).run();
}

}  // namespace carom
