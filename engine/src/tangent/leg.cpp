#include "tangent/leg.h"

#include <cmath>
#include <limits>

namespace carom::tangent {

Dual2 slip_of(const State& s, const Dual& R) {
    return {s.v[0] - R * s.w[1], s.v[1] + R * s.w[0]};
}

void roll(State& s, const Dual& R) {
    s.w[0] = -(s.v[1] / R);
    s.w[1] = s.v[0] / R;
}

namespace {

/// Gives duals the numbers of the record.
void take(Dual3& duals, const Vec3& numbers) {
    for (int i = 0; i < 3; ++i) duals[i].x = numbers[i];
}

}  // namespace

Surface surface_of(const Numbers& n, int ball) {
    const Dual& R = n.balls[ball].R;
    return {R, n.gravity, n.param(&BallParams::mu_s) * n.gravity, n.param(&BallParams::mu_r) * n.gravity,
            2.5 * n.param(&BallParams::mu_sp) * n.gravity / R};
}

State Leg::at(const Dual& time) const {
    State s = from;
    if (is_gone(state)) return s;
    const Dual tau = time - start;
    const Dual half = 0.5 * tau;
    for (int i = 0; i < 2; ++i) {
        s.r[i] = from.r[i] + tau * (from.v[i] + half * a[i]);
        s.v[i] = from.v[i] + tau * a[i];
    }
    if (is_off_cloth(state)) {
        if (flies(state)) s.r[2] = from.r[2] + tau * (from.v[2] - half * gravity);
        s.v[2] = from.v[2] - tau * gravity;
        return s;
    }
    for (int i = 0; i < 2; ++i) s.w[i] = from.w[i] + tau * dw[i];
    if (rolls) roll(s, R);
    if (spin.x > 0.0 && tau.x > 0.0) {
        // Vertical spin has a dead zone: if it is zero, a small change decays at once.
        const double sign = from.w[2].x < 0.0 ? -1.0 : 1.0;
        const Dual left = sign * from.w[2] - spin * tau;
        s.w[2] = left.x > 0.0 ? sign * left : Dual(0.0);
    }
    return s;
}

Leg leg_of(const Segment& segment, const Dual& start, State s, const Surface& surface) {
    take(s.r, segment.r);
    if (!is_off_cloth(segment.state)) s.v[2] = 0.0;
    take(s.v, segment.v);
    take(s.w, segment.w);
    Leg leg;
    leg.start = start;
    leg.spin = surface.spin, leg.gravity = surface.gravity, leg.R = surface.R;
    leg.start.x = segment.start;
    leg.state = segment.state;
    leg.duration = std::numeric_limits<double>::infinity();
    const bool sticks = surface.slide.x > 0.0, slows = surface.roll.x > 0.0;
    switch (segment.state) {
        case MotionState::kSliding: {
            if (!sticks) break;
            const Dual2 u = slip_of(s, surface.R);
            const Dual slip = length(u), turn = 2.5 * surface.slide / surface.R;
            leg.a = {-(surface.slide * u[0] / slip), -(surface.slide * u[1] / slip)};
            leg.dw = {-(turn * u[1] / slip), turn * u[0] / slip};
            leg.duration = 2.0 * slip / (7.0 * surface.slide);
            break;
        }
        case MotionState::kRolling:
        case MotionState::kStationary:
        case MotionState::kSpinning: {
            const bool rolls = segment.state == MotionState::kRolling;
            // A small slip ends at once: the ball rolls at v - 2/7 u.
            if (sticks) {
                const Dual2 u = slip_of(s, surface.R);
                for (int i = 0; i < 2; ++i)
                    for (int k = 0; k < kLanes; ++k) s.v[i].d[k] -= 2.0 / 7.0 * u[i].d[k];
                roll(s, surface.R);
                take(s.w, segment.w);
                leg.rolls = rolls;
            }
            // A small speed ends at once, too.
            if (!rolls && sticks && slows) s.v[0].d = s.v[1].d = s.w[0].d = s.w[1].d = {};
            if (rolls && slows) {
                const Dual speed = length(planar(s.v));
                leg.a = {-(surface.roll * s.v[0] / speed), -(surface.roll * s.v[1] / speed)};
                leg.dw = {-(leg.a[1] / surface.R), leg.a[0] / surface.R};
                leg.duration = speed / surface.roll;
            }
            if (segment.state == MotionState::kSpinning && surface.spin.x > 0.0)
                leg.duration = (s.w[2].x < 0.0 ? -s.w[2] : s.w[2]) / surface.spin;
            break;
        }
        case MotionState::kFalling:
            leg.duration = (sqrt(2.0 * surface.gravity * s.r[2]) + s.v[2]) / surface.gravity;
            break;
        case MotionState::kAirborne: {
            const Dual above = s.r[2] - surface.R;
            if (surface.gravity.x > 0.0)
                leg.duration =
                    (s.v[2] + sqrt(s.v[2] * s.v[2] + 2.0 * surface.gravity * above)) / surface.gravity;
            break;
        }
        case MotionState::kColliding:
            leg.spin = 0.0;
            break;
        case MotionState::kPocketed:
        case MotionState::kOut:
            for (Dual3* part : {&s.v, &s.w})
                for (Dual& x : *part) x = 0.0;
            break;
    }
    leg.from = s;
    return leg;
}

void place_in_space(const Leg& leg, State& s) {
    if (leg.state == MotionState::kFalling) s.r[2] = s.r[2] - s.v[2] * s.v[2] / (2.0 * leg.gravity);
}

}  // namespace carom::tangent
