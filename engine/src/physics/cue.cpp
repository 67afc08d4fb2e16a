#include "physics/cue.h"

#include <cmath>

#include "carom/engine/math.h"

namespace carom {

namespace effects {

// Squirt turns the velocity by -atan2(S, C): a rotation by a ratio. A cue without end mass does not squirt.
[[gnu::noinline]] SinCos squirt(const Cue& cue, const BallSize& ball) {
    const double a = cue.side;
    if (a == 0.0 || cue.end_mass == 0.0) return {0.0, 1.0};
    const double S = 2.5 * a * std::sqrt(1.0 - a * a);
    const double C = 1.0 + ball.m / cue.end_mass + 2.5 * (1.0 - a * a);
    const double h = std::sqrt(S * S + C * C);
    return {-S / h, C / h};
}

}  // namespace effects

StruckBall strike(const Cue& cue, const BallSize& ball, bool squirt) {
    const double a = cue.side, b = cue.height;
    const auto [sin_aim, cos_aim] = sin_cos_deg(cue.aim_deg);
    const auto [sin_up, cos_up] = sin_cos_deg(cue.elevation_deg);
    const double v = (1.0 + cue.restitution) * cue.speed / (1.0 + ball.m / cue.mass + 2.5 * (a * a + b * b));
    // w = (5 v / 2 R) (b l - a sin(th) t - a cos(th) z), l = left of the aim t.
    const double turn = 2.5 * v / ball.R;
    const Vec3 w(turn * (-b * sin_aim - a * sin_up * cos_aim), turn * (b * cos_aim - a * sin_up * sin_aim),
                 -turn * a * cos_up);
    const auto [sin_squirt, cos_squirt] = squirt ? effects::squirt(cue, ball) : SinCos{0.0, 1.0};
    const double speed = v * cos_up;
    return {Vec3(speed * (cos_aim * cos_squirt - sin_aim * sin_squirt),
                 speed * (sin_aim * cos_squirt + cos_aim * sin_squirt), 0.0),
            w, v * sin_up};
}

}  // namespace carom
