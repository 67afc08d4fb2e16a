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
/// @param squirt    whether the plan computes it at all
/// @param vertical  kKeep: v_z is that of the tip's impulse, before the cloth answers, and squirt is spatial
/// where the cue is raised
StruckBall strike(const Cue& cue, const BallSize& ball, bool squirt = true,
                  Vertical vertical = Vertical::kDrop);

/// Whether a ball that lies on the cloth would meet the tip again: it comes back from the cloth faster along
/// the cue than that goes on. The strike is then no single impact. Equation (A8).
/// @param after  the ball when the cloth has answered
bool meets_tip_again(const Cue& cue, const BallSize& ball, const Vec3& v, const Vec3& w);

}  // namespace carom
