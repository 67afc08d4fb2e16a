#include "physics/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "carom/engine/airborne.h"
#include "carom/engine/tolerances.h"

namespace carom {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Returns the time until |w_z| has decayed to 0.
double spin_time(double w_z, const MotionParams& p) {
    return w_z == 0.0 ? 0.0 : (p.spin > 0.0 ? std::abs(w_z) / p.spin : kInfinity);
}

// The segment of a ball without forces; endless.
Segment free_of_forces(double t, const Vec3& r, const Vec3& v, const Vec3& w) {
    Segment s;
    s.start = t;
    s.r = r;
    s.v = v;
    s.w = w;
    s.a = s.dw = Vec2::Zero();
    s.duration = kInfinity;
    return s;
}
}  // namespace

Vec2 cloth_slip(const Vec3& v, const Vec3& w, double R) {
    return {v.x() - R * w.y(), v.y() + R * w.x()};
}

MotionParams motion_params(const BallParams& balls, double gravity, double R) {
    return {.R = R,
            .slide = balls.mu_s * gravity,
            .roll = balls.mu_r * gravity,
            .spin = 5.0 * balls.mu_sp * gravity / (2.0 * R),
            .gravity = gravity,
            .rolls = balls.rolls()};
}

namespace effects {

// Friction of a slipping ball: a = -mu_s g u/|u|,
// dw_xy/dt = -(5 mu_s g / 2R) (u x z)/|u|, until t = 2|u|/(7 mu_s g).
[[gnu::noinline]] void sliding_friction(Segment& s, const Vec2& u, double slip, const MotionParams& p) {
    if (p.slide == 0.0) return;
    const Vec2 direction = u / slip;
    const double turn = 2.5 * p.slide / p.R;
    s.a = -p.slide * direction;
    s.dw = Vec2(-turn * direction.y(), turn * direction.x());
    s.duration = 2.0 * slip / (7.0 * p.slide);
}

// A puck: a = -mu_s g v/|v|, until |v|/(mu_s g). It does not turn.
void puck_friction(Segment& s, double speed, const MotionParams& p) {
    if (p.slide == 0.0) return;
    s.duration = speed / p.slide;
    s.a = planar(s.v) * (-p.slide / speed);
}

// Resistance of a rolling ball: a = -mu_r g v/|v|, until |v|/(mu_r g).
[[gnu::noinline]] void rolling_resistance(Segment& s, double speed, const MotionParams& p) {
    if (p.roll == 0.0) return;
    s.duration = speed / p.roll;
    s.a = planar(s.v) * (-p.roll / speed);
    s.dw = Vec2(-s.a.y() / p.R, s.a.x() / p.R);
}

// The vertical spin decays. A ball that spins in place stops when no spin is left.
[[gnu::noinline]] void spin_decay(Segment& s, const MotionParams& p) {
    if (s.w.z() == 0.0) return;
    s.spin_decay = p.spin;
    if (s.state == MotionState::kSpinning) s.duration = spin_time(s.w.z(), p);
}

}  // namespace effects

namespace {

// [m/s] A ball whose centre and surface, apart from its vertical spin, are slower neither slides nor rolls.
// Impacts at one instant may each remove half of a speed or more, down to numbers whose squares underflow, so
// that the direction of friction is undefined.
constexpr double kStill = 1e-100;

}  // namespace

Segment start_segment(double t, const Vec3& r, const Vec3& v, const Vec3& w, const MotionParams& p) {
    // -0 is no spin either.
    Segment s = free_of_forces(t, r, {v.x(), v.y(), 0.0}, {w.x(), w.y(), w.z() + 0.0});
    const Vec2 u = cloth_slip(s.v, s.w, p.R);
    const double slip = length(u), speed = length(planar(s.v));
    const double spin = std::sqrt(w.x() * w.x() + w.y() * w.y() + w.z() * w.z());
    if (speed < kStill && (speed > 0.0 || w.x() != 0.0 || w.y() != 0.0) &&
        speed + p.R * length(planar(w)) < kStill)
        return start_segment(t, r, Vec3::Zero(), {0.0, 0.0, w.z()}, p);
    if (!p.rolls) {
        s.w.x() = s.w.y() = 0.0;
        s.state = speed > 0.0      ? MotionState::kSliding
                  : s.w.z() != 0.0 ? MotionState::kSpinning
                                   : MotionState::kStationary;
        if (speed > 0.0 && p.sliding) effects::puck_friction(s, speed, p);
    } else if (slip > kRollingUlp * kEpsilon * (speed + p.R * spin)) {
        s.state = MotionState::kSliding;
        if (p.sliding) effects::sliding_friction(s, u, slip, p);
    } else if (speed > 0.0) {
        s.state = MotionState::kRolling;
        s.w.x() = -s.v.y() / p.R;
        s.w.y() = s.v.x() / p.R;
        if (p.rolling) effects::rolling_resistance(s, speed, p);
    } else {
        s.w.x() = s.w.y() = 0.0;
        s.state = s.w.z() != 0.0 ? MotionState::kSpinning : MotionState::kStationary;
    }
    if (p.spin_decay) effects::spin_decay(s, p);
    return s;
}

Segment falling_segment(double t, const Vec3& r, const Vec3& v, const Vec3& w, double falls,
                        const MotionParams& p) {
    Segment s = free_of_forces(t, r, {v.x(), v.y(), -falls}, w);
    s.duration = std::max(0.0, (std::sqrt(2.0 * p.gravity * r.z()) - falls) / p.gravity);
    s.state = MotionState::kFalling;
    return s;
}

Segment airborne_segment(double t, const Vec3& r, const Vec3& v, const Vec3& w, const MotionParams& p) {
    Segment s = free_of_forces(t, r, v, w);
    s.state = MotionState::kAirborne;
    const double g = p.gravity, c = std::max(0.0, r.z() - p.R), v_z = v.z();
    const double root = std::sqrt(v_z * v_z + 2.0 * g * c);
    if (v_z < 0.0)
        s.duration = c > 0.0 ? 2.0 * c / (root - v_z) : 0.0;
    else if (g > 0.0)
        s.duration = (v_z + root) / g;
    return s;
}

Segment free_segment(double t, const Vec3& r, const Vec3& v, const Vec3& w, const MotionParams& p) {
    if (!(r.z() > p.R) && (v.z() <= 0.0 || v.z() < bounce_end(p.R, p.gravity)))
        return start_segment(t, r, v, w, p);
    return airborne_segment(t, r, v, w, p);
}

Vec3 landing_velocity(const Segment& s, const MotionParams& p) {
    const double c = std::max(0.0, s.r.z() - p.R);
    return {s.v.x(), s.v.y(), -std::sqrt(s.v.z() * s.v.z() + 2.0 * p.gravity * c)};
}

Segment colliding_segment(double t, const Vec3& r, const Vec3& path, const Vec3& w, double duration) {
    Segment s;
    s.start = t;
    s.r = r;
    s.v = path / duration;
    s.w = w;
    s.a = s.dw = Vec2::Zero();
    s.duration = duration;
    s.state = MotionState::kColliding;
    return s;
}

Segment pocketed_segment(double t, const Pocket& pocket) {
    Segment s =
        free_of_forces(t, {pocket.center.x(), pocket.center.y(), -pocket.depth}, Vec3::Zero(), Vec3::Zero());
    s.state = MotionState::kPocketed;
    return s;
}

Segment after_transition(const Segment& s, const MotionParams& p) {
    const double tau = s.duration;
    const Vec3 r = position_at(s, tau);
    Vec3 v = Vec3::Zero(), w(0.0, 0.0, spin_at(s, tau, p.R).z());
    if (s.state == MotionState::kSpinning) w.z() = 0.0;
    if (s.state == MotionState::kSliding && p.rolls) {
        // v_f = v - (2/7) u, and the spin of rolling at v_f.
        const Vec2 u = cloth_slip(s.v, s.w, p.R);
        v = Vec3(s.v.x() - u.x() * (2.0 / 7.0), s.v.y() - u.y() * (2.0 / 7.0), 0.0);
        w.x() = -v.y() / p.R;
        w.y() = v.x() / p.R;
    }
    return start_segment(s.start + tau, r, v, w, p);
}

EventType transition_type(const Segment& segment, const Segment& next) {
    // Friction turns every sliding ball, but no puck.
    const bool puck = segment.dw.isZero(0.0) && next.state != MotionState::kRolling;
    if (segment.state == MotionState::kSliding && !puck) return EventType::kSlideRoll;
    if (segment.state == MotionState::kSpinning) return EventType::kSpinStop;
    return next.state == MotionState::kSpinning ? EventType::kRollSpin : EventType::kRollStop;
}

}  // namespace carom
