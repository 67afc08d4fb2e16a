#include "physics/cue.h"

#include <cmath>

#include "carom/engine/math.h"

namespace carom {

namespace effects {

// Squirt turns the velocity by -atan2(S, C), computed as a ratio. A cue without end mass produces no squirt.
[[gnu::noinline]] SinCos squirt(const Cue& cue, const BallSize& ball) {
    const double a = cue.side;
    if (a == 0.0 || cue.end_mass == 0.0) return {0.0, 1.0};
    const double S = 2.5 * a * std::sqrt(1.0 - a * a);
    const double C = 1.0 + ball.m / cue.end_mass + 2.5 * (1.0 - a * a);
    const double h = std::sqrt(S * S + C * C);
    return {-S / h, C / h};
}

// The same in space: the velocity turns away from the offset by that angle, in the plane of the cue and the
// contact point.
[[gnu::noinline]] Vec3 spatial_squirt(const Cue& cue, const BallSize& ball, const Vec3& along,
                                      const Vec3& left, const Vec3& up) {
    const double a = cue.side, b = cue.height, r = std::sqrt(a * a + b * b);
    if (r == 0.0 || cue.end_mass == 0.0) return along;
    const double S = 2.5 * r * std::sqrt(1.0 - r * r);
    const double C = 1.0 + ball.m / cue.end_mass + 2.5 * (1.0 - r * r);
    const double h = std::sqrt(S * S + C * C);
    return C / h * along - S / h * (a / r * left + b / r * up);
}

}  // namespace effects

namespace {

struct Axes {
    Vec3 along, left, up;
};
Axes axes_of(const SinCos& aim, const SinCos& elevation) {
    return {{aim.cos * elevation.cos, aim.sin * elevation.cos, -elevation.sin},
            {-aim.sin, aim.cos, 0.0},
            {aim.cos * elevation.sin, aim.sin * elevation.sin, elevation.cos}};
}

/// [m/s] Speed of the ball along the cue.
double struck_speed(const Cue& cue, const BallSize& ball) {
    const double a = cue.side, b = cue.height;
    return (1.0 + cue.restitution) * cue.speed / (1.0 + ball.m / cue.mass + 2.5 * (a * a + b * b));
}

}  // namespace

StruckBall strike(const Cue& cue, const BallSize& ball, bool squirt, Vertical vertical) {
    const double a = cue.side, b = cue.height;
    const auto [sin_aim, cos_aim] = sin_cos_deg(cue.aim_deg);
    const auto [sin_up, cos_up] = sin_cos_deg(cue.elevation_deg);
    const double v = struck_speed(cue, ball);
    // w = (5 v / 2 R) (b l - a sin(th) t - a cos(th) z), l = left of the aim t.
    const double turn = 2.5 * v / ball.R;
    const Vec3 w(turn * (-b * sin_aim - a * sin_up * cos_aim), turn * (b * cos_aim - a * sin_up * sin_aim),
                 -turn * a * cos_up);
    if (vertical == Vertical::kKeep && cue.elevation_deg > 0.0) {
        const Axes axes = axes_of({sin_aim, cos_aim}, {sin_up, cos_up});
        const Vec3 direction =
            squirt ? effects::spatial_squirt(cue, ball, axes.along, axes.left, axes.up) : axes.along;
        return {v * direction, w, 0.0};
    }
    const auto [sin_squirt, cos_squirt] = squirt ? effects::squirt(cue, ball) : SinCos{0.0, 1.0};
    const double speed = v * cos_up;
    return {Vec3(speed * (cos_aim * cos_squirt - sin_aim * sin_squirt),
                 speed * (sin_aim * cos_squirt + cos_aim * sin_squirt), 0.0),
            w, v * sin_up};
}

bool meets_tip_again(const Cue& cue, const BallSize& ball, const Vec3& v, const Vec3& w) {
    const double a = cue.side, b = cue.height;
    const Axes axes = axes_of(sin_cos_deg(cue.aim_deg), sin_cos_deg(cue.elevation_deg));
    const Vec3 tip = ball.R * (a * axes.left + b * axes.up - std::sqrt(1.0 - a * a - b * b) * axes.along);
    // The cue keeps its remaining momentum.
    const double cue_speed = cue.speed - ball.m / cue.mass * struck_speed(cue, ball);
    return !(dot3(v + cross3(w, tip), axes.along) > cue_speed);
}

}  // namespace carom
