// The cue's stroke.
#pragma once

#include "carom/engine/scene.h"

namespace carom {

/// Velocity and spin of a resting ball after the stroke. Source: docs/reference/physics.md (instantaneous
/// point impact; squirt after Alciatore's end-mass analysis, TP A.31).
struct StruckBall {
    Vec3 v, w;
    double dropped_vertical;  ///< vertical speed that a planar scene drops [m/s]
};
/// @param squirt    whether the plan computes squirt
/// @param vertical  kKeep: v_z is from the tip's impulse, before the cloth reacts, and squirt is spatial if
/// the cue is raised
StruckBall strike(const Cue& cue, const BallSize& ball, bool squirt = true,
                  Vertical vertical = Vertical::kDrop);

/// Whether a ball on the cloth would hit the tip again, because it rebounds from the cloth faster along the
/// cue than the cue moves. The stroke is then more than a single impact. Equation (A8).
/// @param v, w  the ball after the cloth has reacted
bool meets_tip_again(const Cue& cue, const BallSize& ball, const Vec3& v, const Vec3& w);

}  // namespace carom
