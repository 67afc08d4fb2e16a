#include "carom/engine/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "carom/engine/airborne.h"
#include "carom/engine/tolerances.h"
#include "contact/touch.h"
#include "physics/motion.h"
#include "record/gaps.h"
#include "record/verify_between.h"
#include "record/verify_effects.h"

namespace carom {

namespace {

// [of the energy] Bound on the loss from integrating a cluster in steps; losses up to 1e-6 were seen.
constexpr double kStepsLose = 1e-5;

// Returns the ball's mass divided by that in [balls]: 1 in most scenes.
double mass(const Record& record, int ball) {
    return record.size(ball).m / record.balls.m;
}

std::vector<BallState> states_at(const Record& record, double t) {
    std::vector<BallState> states;
    for (std::size_t i = 0; i < record.tracks.size(); ++i)
        states.push_back(record.state_at(static_cast<int>(i), t));
    return states;
}

double energy_of(const Record& record, const std::vector<BallState>& states) {
    double energy = 0.0;
    for (std::size_t i = 0; i < states.size(); ++i)
        energy += ball_energy(record, static_cast<int>(i), states[i]);
    return energy;
}

bool keeps_energy(const Plan& plan) {
    const Physics& physics = plan.scene.physics;
    return !plan.ball_ball->reads_cloth ||
           (physics.cloth_slip == kernel::ClothSlip::kConsistent && physics.substeps.value_or(100) >= 100);
}

class Checker {
  public:
    Checker(const Record& record, const Plan& plan) : record_(record), plan_(plan) {}

    std::optional<Violation> run() {
        check_finite();
        std::vector<BallState> start = states_at(record_, 0.0);
        enter_clusters(start, 0.0);
        double last_time = 0.0, last_energy = energy_of(record_, start);
        bool lasted = false;  // whether a cluster took place since last_energy
        const double first_energy = std::max(last_energy, first_energy_after_cue());
        const double rounding = height_rounding(record_);
        const bool lossless = loses_nothing(plan_) && !plan_.scene.physics.substeps;
        for (event_ = 0; event_ < record_.events.size() && !found_; ++event_) {
            const Event& e = record_.events[event_];
            if (!(e.time >= last_time))
                report("U2", "time falls from {:.17g} to {:.17g} s", last_time, e.time);
            last_time = e.time;
            check_crowd();
            // Of simultaneous events, the laws hold for the state after the last one.
            const bool last_of_instant =
                event_ + 1 == record_.events.size() || record_.events[event_ + 1].time > e.time;
            if (!last_of_instant) continue;
            std::vector<BallState> now = states_at(record_, e.time);
            check_penetration(now, e.time);
            check_rolling(e.time);
            // During a cluster the contacts store energy, too; the check waits for the next instant outside
            // clusters.
            const bool lasts = std::any_of(now.begin(), now.end(), [](const BallState& ball) {
                return ball.state == MotionState::kColliding;
            });
            if (lasts && !enter_clusters(now, e.time)) continue;
            const double energy = energy_of(record_, now) + chord_energy(record_, e.time);
            if (e.type == EventType::kCueStrike) last_energy = energy;
            const double allowed = 1e-12 * first_energy + rounding + slow_contacts(e.time);
            if (keeps_energy(plan_) && energy > last_energy + allowed)
                report("U4", "energy rises from {:.17g} to {:.17g} J/kg", last_energy, energy);
            const bool cluster = lasted || happens(EventType::kBallCluster, e.time);
            const double lost = allowed + (cluster ? kStepsLose * last_energy : 0.0);
            if (lossless && !happens(EventType::kCueStrike, e.time) && energy < last_energy - lost)
                report("U4", "energy falls from {:.17g} to {:.17g} J/kg, and nothing dissipates it",
                       last_energy, energy);
            last_energy = energy;
            lasted = lasts;
        }
        check_impacts();
        check_rest();
        return found_;
    }

  private:
    double R(std::size_t ball) const { return record_.size(static_cast<int>(ball)).R; }

    const Segment& segment_at(std::size_t ball, double t) const {
        const BallTrack& track = record_.tracks[ball];
        return track.segments[track.segment_at(t)];
    }

    // Replaces the states of colliding balls by those in which they enter their clusters.
    // @return false if a cluster began before t
    bool enter_clusters(std::vector<BallState>& states, double t) const {
        for (std::size_t i = 0; i < states.size(); ++i) {
            const Segment& s = segment_at(i, t);
            if (s.state != MotionState::kColliding) continue;
            if (s.start < t) return false;
            states[i] = entering(record_, i, s);
        }
        return true;
    }

    template <class... Values>
    void report(const char* law, fmt::format_string<Values...> message, Values&&... values) {
        if (!found_) found_ = Violation{event_, law, fmt::format(message, std::forward<Values>(values)...)};
    }

    // [m/s] Possible error of the impact kernel in each velocity.
    double velocity_error(double approach) const {
        const Physics& physics = plan_.scene.physics;
        const bool to_tolerance = plan_.ball_ball->reads_tolerance && !physics.substeps;
        return to_tolerance ? physics.tolerance * std::abs(approach) : 0.0;
    }

    double first_energy_after_cue() const {
        const bool cue = !record_.events.empty() && record_.events[0].type == EventType::kCueStrike;
        return cue ? energy_at(record_, record_.events[0].time) : 0.0;
    }

    // Whether the present instant has an event of this type.
    bool happens(EventType type, double time) const {
        for (std::size_t k = event_ + 1; k-- > 0 && record_.events[k].time == time;)
            if (record_.events[k].type == type) return true;
        return false;
    }

    // [J/kg] Energy that slow contacts of flying balls may add at an instant: each separates at
    // parting_speed().
    double slow_contacts(double time) const {
        if (!plan_.in_force(Effect::kAirborne)) return 0.0;
        double energy = 0.0;
        for (std::size_t k = event_ + 1; k-- > 0 && record_.events[k].time == time;) {
            const Event& e = record_.events[k];
            if (!e.slow) continue;
            // Two balls separate at the speed for the larger one, and the heavier one may be the flying one.
            const int other = kind(e.type).partner == Partner::kBall ? e.b : e.a;
            const double larger = std::max(record_.size(e.a).R, record_.size(other).R),
                         heavier = std::max(mass(record_, e.a), mass(record_, other)),
                         parting = parting_speed(larger, record_.gravity);
            energy += heavier * parting * parting;
        }
        return energy;
    }

    void check_finite() {
        for (const BallTrack& track : record_.tracks) {
            for (const Segment& s : track.segments) {
                const bool ok = std::isfinite(s.start) && s.r.allFinite() && s.v.allFinite() &&
                                s.w.allFinite() && s.a.allFinite() && s.dw.allFinite() &&
                                std::isfinite(s.spin_decay) && !std::isnan(s.duration) && s.duration >= 0.0;
                if (!ok)
                    report("U1", "ball {} at {:.17g} s has a number that is not finite", track.id, s.start);
            }
        }
    }

    void check_crowd() {
        const std::size_t cap = static_cast<std::size_t>(kEventCap);
        if (event_ > cap && record_.events[event_].time - record_.events[event_ - cap].time < kEventCapSpan)
            report("U8", "too many events in one span");
    }

    void check_penetration(const std::vector<BallState>& now, double t) {
        const auto seen = [&](std::size_t i) {
            return see(record_, i, record_.tracks[i].segment_at(t), now[i].position,
                       rounding_of(now[i].velocity, now[i].spin, R(i), t), plan_.in_force(Effect::kAirborne));
        };
        for (std::size_t i = 0; i < now.size(); ++i) {
            if (is_gone(now[i].state)) continue;
            const SeenBall ball = seen(i);
            const std::string& id = record_.tracks[i].id;
            for (std::size_t j = i + 1; j < now.size(); ++j) {
                if (is_gone(now[j].state)) continue;
                const SeenBall other = seen(j);
                const double gap = gap_between(ball, other);
                if (gap < -allowed_depth(ball) - other.rounding && !share_cluster(record_, i, j, t))
                    report("U3", "balls {} and {} overlap by {:.3g} m", id, record_.tracks[j].id, -gap);
            }
            // A ball may cross a cushion's line only beyond the cushion's ends.
            for (const CushionLine& line : plan_.geometry.cushions)
                if (const double gap = gap_to(line, ball); gap < -allowed_depth(ball, line.from))
                    report("U3", "ball {} is {:.3g} m deep in a cushion", id, -gap);
            for (const Nose& nose : plan_.geometry.noses)
                if (const double gap = gap_to(nose, ball); gap < -allowed_depth(ball, nose.center))
                    report("U3", "ball {} is {:.3g} m deep in a jaw or cushion end", id, -gap);
            if (const double gap = gap_to_cloth(ball); gap < -allowed_depth(ball))
                report("U3", "ball {} is {:.3g} m deep in the cloth", id, -gap);
        }
    }

    // Checks the segment itself, because state_at derives the spin of a rolling ball from its velocity.
    void check_rolling(double time) {
        for (std::size_t i = 0; i < record_.tracks.size(); ++i) {
            const BallTrack& track = record_.tracks[i];
            const Segment& s = segment_at(i, time);
            if (s.state == MotionState::kRolling &&
                length(cloth_slip(s.v, s.w, R(i))) > 1e-13 * length(planar(s.v)))
                report("U7", "ball {} rolls and slips", track.id);
        }
    }

    // Contacts conserve the momentum of a cluster; the cloth may absorb some.
    void check_cluster(const Event& e) {
        if (plan_.balls.mu_s > 0.0) return;
        Vec2 change = Vec2::Zero();
        double scale = 0.0;
        for (const int ball : record_.clusters[static_cast<std::size_t>(e.detail)]) {
            const Segment& s = segment_at(static_cast<std::size_t>(ball), e.time);
            if (s.state != MotionState::kColliding || s.start != e.time) return;
            const Vec3 before = entering(record_, static_cast<std::size_t>(ball), s).velocity;
            change += mass(record_, ball) * planar((&s + 1)->v - before);
            scale += mass(record_, ball) * (s.v.norm() + before.norm());
        }
        if (length(change) > 1e-12 * scale)
            report("U5", "the cluster changes the momentum of its balls by {:.3g} m/s", length(change));
    }

    // Compares the velocities before and after a ball-ball impact, at the ends of the adjoining segments.
    void check_impacts() {
        for (event_ = 0; event_ < record_.events.size() && !found_; ++event_) {
            const Event& e = record_.events[event_];
            if (e.type == EventType::kBallCluster) check_cluster(e);
            if (e.type != EventType::kBallBall) continue;
            // Only if each ball has exactly one segment that starts here, because two impacts at one instant
            // cannot be distinguished.
            const Segment *before1, *after1, *before2, *after2;
            if (!around(e.a, e.time, before1, after1) || !around(e.b, e.time, before2, after2)) continue;
            const auto is_free = [this](const Segment& s) {
                return plan_.in_force(Effect::kAirborne) && is_off_cloth(s.state);
            };
            const bool free = plan_.ball_ball->free || is_free(*before1) || is_free(*before2);
            if (free && (hits_cloth(e.a, e.time) || hits_cloth(e.b, e.time))) continue;
            const auto velocity = [&](const Segment& s) {
                return free ? placed_at(s, e.time - s.start, record_.gravity).velocity
                            : velocity_at(s, e.time - s.start);
            };
            const Vec3 v1 = velocity(*before1), v2 = velocity(*before2);
            const double R1 = R(static_cast<std::size_t>(e.a)), R2 = R(static_cast<std::size_t>(e.b));
            const double m1 = mass(record_, e.a), m2 = mass(record_, e.b);
            const Vec3 w1 = spin_at(*before1, e.time - before1->start, R1),
                       w2 = spin_at(*before2, e.time - before2->start, R2);
            const BallAt<Vec3> ball1{after1->r, v1, R1}, ball2{after2->r, v2, R2};
            const Vec3 n3 = (free ? touch_ball(ball1, ball2) : touch_level(ball1, ball2, true)).n;
            // Balls of two radii on the cloth touch along a tilted line.
            const double S = free || record_.balls.discs() ? 0.0 : (R2 - R1) / (R1 + R2),
                         C = std::sqrt(1.0 - S * S);
            const Vec3 line = S == 0.0 ? n3 : Vec3(C * n3.x(), C * n3.y(), S);
            // A slow contact keeps a ball on the cloth, and a rise below bounce_end() leaves it there.
            const bool lies = !flies(after1->state) || !flies(after2->state);
            if (free && lies) continue;
            const double scale = m1 * (v1.norm() + R1 * w1.norm()) + m2 * (v2.norm() + R2 * w2.norm());
            // In the plane of the cloth, because an impact does not change a fall.
            const double up1 = free ? after1->v.z() - v1.z() : 0.0, up2 = free ? after2->v.z() - v2.z() : 0.0;
            const Vec3 dv1(after1->v.x() - v1.x(), after1->v.y() - v1.y(), up1),
                dv2(after2->v.x() - v2.x(), after2->v.y() - v2.y(), up2);
            const Vec3 change = m1 * dv1 + m2 * dv2;
            const Vec3 dw1 = m1 * R1 * (after1->w - w1), dw2 = m2 * R2 * (after2->w - w2);
            // Over the whole impact the friction of the cloth is at most mu_s times the vertical friction,
            // which is at most mu_b times the normal impulse.
            const double J_n = std::max(m1 * std::abs(dv1.dot(n3)), m2 * std::abs(dv2.dot(n3)));
            const bool cloth = !free && plan_.balls.mu_s > 0.0 && plan_.ball_ball->reads_cloth;
            const double mu_b = plan_.balls.ball_friction().most(), steep = std::abs(S);
            const double limit =
                cloth ? plan_.balls.mu_s * (C * mu_b + steep) * J_n / (C - steep * mu_b) : 0.0;
            // A straight shot reaches that limit exactly, and an impact is solved to a tolerance.
            const double solved = cloth ? (m1 + m2) * velocity_error((v1 - v2).dot(n3)) : 0.0;
            if (change.norm() > limit + solved + 64.0 * kEpsilon * scale)
                report("U5", "the impact changes the pair's momentum by {:.3g} m/s", change.norm());
            const double rounding = 1e-12 * scale;
            if (!cloth && (std::abs(dw1.dot(line)) > rounding || std::abs(dw2.dot(line)) > rounding ||
                           (dw1 - dw2).norm() > rounding))
                report(
                    "U6",
                    "the impact turns a ball about the line of centres, or the two spins change differently");
        }
    }

    bool hits_cloth(int ball, double time) const {
        return std::any_of(record_.events.begin(), record_.events.end(), [&](const Event& e) {
            return e.type == EventType::kBallCloth && e.a == ball && e.time == time;
        });
    }

    bool around(int ball, double time, const Segment*& before, const Segment*& after) const {
        const std::vector<Segment>& segments = record_.tracks[ball].segments;
        const auto first = std::lower_bound(segments.begin(), segments.end(), time,
                                            [](const Segment& s, double t) { return s.start < t; });
        if (first == segments.begin() || first == segments.end() || first->start != time) return false;
        if (first + 1 != segments.end() && (first + 1)->start == time) return false;
        before = &*(first - 1);
        after = &*first;
        return true;
    }

    void check_rest() {
        if (record_.stopped != StopReason::kAtRest || found_) return;
        event_ = record_.events.size();
        for (std::size_t i = 0; i < record_.tracks.size(); ++i) {
            const Segment& s = record_.tracks[i].segments.back();
            const bool at_rest = s.state == MotionState::kStationary || is_gone(s.state);
            if (!at_rest) report("U9", "ball {} has not come to rest", record_.tracks[i].id);
        }
    }

    const Record& record_;
    const Plan& plan_;
    std::size_t event_ = 0;
    std::optional<Violation> found_;
};

}  // namespace

double energy_at(const Record& record, double t) {
    return energy_of(record, states_at(record, t));
}

std::optional<Violation> verify(const Record& record, const Plan& plan) {
    if (auto violation = Checker(record, plan).run()) return violation;
    if (auto violation = verify_between(record, plan, keeps_energy(plan))) return violation;
    return verify_skipped(record, plan);
}

}  // namespace carom
