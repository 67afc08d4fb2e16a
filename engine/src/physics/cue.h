// Cue strike.
#pragma once

#include "carom/engine/scene.h"

namespace carom {

/// Velocity and spin of a resting ball after the strike. Source: physics, section 5 (instantaneous point
/// impact; squirt after Alciatore's end-mass analysis, TP A.31).
struct StruckBall {
    Vec3 v, w;
    double dropped_vertical;  ///< vertical speed that a planar scene drops [m/s]
};
/// @param squirt  whether the plan computes it at all
StruckBall strike(const Cue& cue, const BallSize& ball, bool squirt = true);

}  // namespace carom
