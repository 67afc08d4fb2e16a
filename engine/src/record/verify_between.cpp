// Checks between the events of a record: overlaps, penetrated cushions, energy.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/airborne.h"
#include "carom/engine/tolerances.h"
#include "contact/detect.h"
#include "contact/roots.h"
#include "contact/touch.h"
#include "physics/motion.h"
#include "physics/reach.h"
#include "record/verify_parts.h"

namespace carom {
namespace {

// [R] Longest step past a gap that is smaller: a graze up to a thousandth of R deep may remain unseen.
constexpr double kLongestStep = 0.125;
// [of the energy] Bound on the loss from integrating a cluster in steps; losses up to 1e-6 were seen.
constexpr double kStepsLose = 1e-5;
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
    double speed = 0.0;   ///< [m/s] most in this piece
    double energy = 0.0;  ///< [J/kg] at the start
};

class Between {
  public:
    Between(const Record& record, const Plan& plan, bool energy)
        : record_(record),
          plan_(plan),
          keeps_energy_(energy),
          lossless_(loses_nothing(plan) && !plan.scene.physics.substeps),
          rounding_(height_rounding(record)),
          pieces_(record.tracks.size()) {}

    std::optional<Violation> run() {
        for (const BallTrack& track : record_.tracks)
            for (const Segment& s : track.segments)
                // A stop may come before the end of a cluster, whose later segments are in the record.
                if (s.start < record_.duration) times_.push_back(s.start);
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
                               fmt::format(", {:.17g} s after the start", t)};
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

    // [J/kg] Energy that a slow contact of flying balls may add: it separates at parting_speed().
    double slow_contact(const Event& e) const {
        if (!e.slow || !plan_.in_force(Effect::kAirborne)) return 0.0;
        // Two balls separate at the speed for the larger one, and the heavier one may be the flying one.
        const int other = kind(e.type).partner == Partner::kBall ? e.b : e.a;
        const BallSize one = record_.size(e.a), two = record_.size(other);
        const double parting = parting_speed(std::max(one.R, two.R), record_.gravity);
        return std::max(one.m, two.m) / record_.balls.m * parting * parting;
    }

    void look(double from, double to) {
        for (std::size_t i = 0; i < pieces_.size(); ++i) begin(i, from, to - from);
        check_energy(from);
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
        const double v = piece.moves ? length(planar(velocity_at(s, tau))) : 0.0,
                     more = piece.moves ? duration * length(s.a) : 0.0;
        piece.speed = v + more;
        if (is_off_cloth(s.state)) piece.speed += std::abs(s.v.z()) + record_.gravity * (tau + duration);
        piece.reach = duration * (v + 0.5 * more);
    }

    // Energy at the ends of a piece bounds that between them, because velocities change linearly.
    void check_energy(double t) {
        double added = 0.0;
        bool struck = t == times_.front(), ends = true, lasts = false;
        for (; event_ < record_.events.size() && record_.events[event_].time <= t; ++event_) {
            const Event& e = record_.events[event_];
            added += slow_contact(e);
            clusters_ = clusters_ || e.type == EventType::kBallCluster;
            struck = struck || e.type == EventType::kCueStrike;
        }
        // During a cluster the contacts store energy, too; the check waits for the next instant outside it.
        double now = chord_energy(record_, t);
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            now += pieces_[i].energy;
            const bool collides = segment(i).state == MotionState::kColliding;
            lasts = lasts || collides;
            ends = ends && !(collides && segment(i).start < t);
        }
        if (!ends) return;
        if (struck) first_energy_ = std::max(first_energy_, last_energy_ = now);
        const double allowed = 1e-12 * first_energy_ + rounding_ + added;
        if (keeps_energy_ && now > last_energy_ + allowed)
            report("U4", t, "energy rises from {:.17g} to {:.17g} J/kg", last_energy_, now);
        if (lossless_ && now < last_energy_ - allowed - (clusters_ ? kStepsLose * last_energy_ : 0.0))
            report("U4", t, "energy falls from {:.17g} to {:.17g} J/kg, and nothing dissipates it",
                   last_energy_, now);
        if (found_ && event_ > 0) found_->event = event_ - 1;
        last_energy_ = now;
        clusters_ = lasts;
    }

    // Calls check(t) wherever two bodies may touch: clear(t) is a lower bound of their distance, which falls
    // at `speed` at most.
    template <class Clear, class Check>
    void follow(double from, double to, double R, double speed, const Clear& clear, const Check& check) {
        for (double t = from; !found_;) {
            const double gap = clear(t);
            if (!(gap > 0.0)) check(t);
            if (!(t < to) || !(speed > 0.0)) return;
            t = std::min(to, std::max(t + std::max(gap, kLongestStep * R) / speed, std::nextafter(t, to)));
        }
    }

    void check_pair(std::size_t i, std::size_t j, double from, double to) {
        const Piece &p = pieces_[i], &q = pieces_[j];
        if (p.pocketed || !(p.moves || q.moves || p.begins || q.begins)) return;
        const double near = R(i) + R(j) + p.reach + q.reach;
        const Vec2 apart = q.r - p.r;
        if (dot(apart, apart) > near * near) return;
        const std::pair key(i, j);
        const auto clear = [&](double t) {
            const double gap = length(place(i, t) - place(j, t)) - R(i) - R(j);
            if (gap > 0.0 && !left_.empty()) left_.erase(key);
            return gap;
        };
        const Segment &a = segment(i), &b = segment(j);
        const bool share = a.state == MotionState::kColliding && b.state == a.state && a.start == b.start;
        follow(from, to, std::min(R(i), R(j)), p.speed + q.speed, clear, [&](double t) {
            const SeenBall one = seen(i, t), other = seen(j, t);
            const double depth = -gap_between(one, other), allowed = allowed_depth(one) + other.rounding;
            const auto left = left_.find(key);
            if (share)
                left_[key] = depth;
            else if (!(depth > allowed))
                left_.erase(key);
            else if (left != left_.end() && depth <= left->second + allowed)
                left->second = std::min(left->second, depth);
            else
                report("U3", t, "balls {} and {} overlap by {:.3g} m", id(i), id(j), depth);
        });
    }

    template <class Part, class Check>
    void follow_part(std::size_t ball, const Part& part, double radius, double from, double to,
                     const Check& check) {
        const double reach = radius + (flies(segment(ball).state) ? kNoseReach * R(ball) : R(ball));
        const auto clear = [&](double t) {
            const Vec2 r = place(ball, t);
            return length(nearest_point(part, r) - r) - reach;
        };
        follow(from, to, R(ball), pieces_[ball].speed, clear, [&](double t) { check(seen(ball, t), t); });
    }

    // In a cluster a ball is drawn straight from its start to its end, which may cut a corner.
    void check_table(std::size_t ball, double from, double to) {
        if (segment(ball).state == MotionState::kColliding) return;
        const double near = kNoseReach * R(ball) + pieces_[ball].reach;
        const bool in_air = flies(segment(ball).state);
        // With a bed there is cloth on both sides of a cushion.
        const bool may_cross = in_air && plan_.scene.table.bed;
        for (const CushionLine& line : plan_.geometry.cushions) {
            if (std::abs(in_frame(line, pieces_[ball].r - line.from).y()) > near) continue;
            if (!may_cross) check_crossing(ball, line, from, to);
            follow_part(ball, line, 0.0, from, to, [&](const SeenBall& there, double t) {
                if (const double gap = gap_to(line, there); gap < -allowed_depth(there, line.from))
                    report("U3", t, "ball {} is {:.3g} m deep in a cushion", id(ball), -gap);
            });
        }
        for (const Nose& nose : plan_.geometry.noses) {
            const Vec2 apart = pieces_[ball].r - nose.center;
            const double far = near + std::abs(nose.radius);
            if (dot(apart, apart) > far * far) continue;
            if (nose.is_arc() && !in_air) check_passing(ball, nose, from, to);
            follow_part(
                ball, nose, nose.is_arc() ? 0.0 : nose.radius, from, to,
                [&](const SeenBall& there, double t) {
                    // A ball may come through an arc from behind.
                    const Vec2 towards = nearest_point(nose, planar(there.r)) - planar(there.r);
                    const Vec3 v = velocity_at(segment(ball), t - segment(ball).start);
                    const bool leaves = nose.is_arc() && dot(towards, planar(v)) < 0.0;
                    const double gap = gap_to(nose, there);
                    if (gap < -allowed_depth(there, nose.center) && !leaves)
                        report("U3", t, "ball {} is {:.3g} m deep in a jaw or cushion end", id(ball), -gap);
                    // It would land inside the jaw.
                    const double over = nose.radius - length(planar(there.r) - nose.center);
                    if (in_air && over > allowed_depth(there, nose.center))
                        report("U3", t, "ball {} flies on {:.3g} m behind the nose of a jaw", id(ball), over);
                });
        }
        // The cloth ends at the edge of a pocket.
        for (const Pocket& pocket : plan_.geometry.pockets) {
            const auto clear = [&](double t) {
                return length(place(ball, t) - pocket.center) - pocket.radius;
            };
            if (in_air || segment(ball).state == MotionState::kFalling || clear(from) > pieces_[ball].reach)
                continue;
            follow(from, to, R(ball), pieces_[ball].speed, clear, [&](double t) {
                if (-clear(t) > allowed_depth(seen(ball, t), pocket.center))
                    report("U3", t, "ball {} is {:.3g} m beyond the edge of pocket {} and does not fall",
                           id(ball), -clear(t), pocket.id);
            });
        }
        const SeenBall there = seen(ball, from);
        if (const double gap = gap_to_cloth(there); gap < -allowed_depth(there))
            report("U3", from, "ball {} is {:.3g} m deep in the cloth", id(ball), -gap);
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
    const bool keeps_energy_, lossless_;
    std::size_t event_ = 0;  // the first one after the present instant
    bool clusters_ = false;  // whether one took place since last_energy_
    const double rounding_;  // [J/kg]
    std::vector<Piece> pieces_;
    // [m] Overlaps that a cluster left behind, because one of the two was hit before its end: each may only
    // shrink.
    std::map<std::pair<std::size_t, std::size_t>, double> left_;
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
