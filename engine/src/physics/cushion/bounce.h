// The impact of a ball on the cloth with all the noses that it touches at one instant.
#pragma once

#include <optional>
#include <span>

#include "carom/engine/cushion.h"
#include "carom/engine/motion.h"
#include "carom/engine/scene.h"
#include "carom/engine/tolerances.h"

namespace carom {

struct NoseTouch {
    Vec2 normal;          ///< unit, from the part into the table
    double height = 0.0;  ///< [m] of the nose above the cloth
    const CushionModelInfo* model = nullptr;
};

/// [m/s] A smaller closing speed of a ball with these velocities is rounding.
inline double closing_noise(double R, const Velocities& ball) {
    return kClosingUlp * kEpsilon * (length(planar(ball.v)) + R * ball.w.norm());
}

/// Replaces the velocities of a ball by those after it has hit all touches at once. One touch: its model. Two
/// touches: the sum of their impulses, each computed from the incoming state, scaled so that the ball leaves
/// each part at the speed at which it would leave that part alone. If that would add energy, or with more
/// touches: the mean of the states after each, repeated until none closes (docs/design/hard_cases.md, "Two
/// contacts at one instant").
/// @param hops  [m/s^2] gravity, if the first nose may throw the ball up: v_z is then the hop, otherwise 0
/// @param tolerance  of models that integrate: physics.tolerance
/// @return false if a model has no solution
bool bounce(const BallParams& balls, const BallSize& size, std::span<const NoseTouch> touches,
            std::optional<double> hops, double tolerance, Velocities& ball);

}  // namespace carom
