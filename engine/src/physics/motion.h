// One ball between two events: closed-form motion and the next own transition. Source: physics, section 1
// (Leckie and Greenspan, "An event-based pool physics simulator", 2005).
#pragma once

#include "carom/engine/motion.h"
#include "carom/engine/record.h"
#include "carom/engine/scene.h"

namespace carom {

/// Slip at the cloth, u = v + w x (-R z) = (v_x - R w_y, v_y + R w_x) [m/s].
Vec2 cloth_slip(const Vec3& v, const Vec3& w, double R);

/// @param R  radius of the ball
MotionParams motion_params(const BallParams& balls, double gravity, double R);

/// The segment that starts at time t with these velocities. The motion state follows from them: rolling when
/// the slip is at most kRollingUlp ulp of |v| + R |w| (spin is then set to the rolling one), and so on.
Segment start_segment(double t, const Vec3& r, const Vec3& v, const Vec3& w, const MotionParams& params);

/// The segment of a ball that lies in a pocket.
Segment pocketed_segment(double t, const Pocket& pocket);

/// The ball's own next transition: its state at the end of the segment, as the segment that follows.
Segment after_transition(const Segment& segment, const MotionParams& params);

/// The type of that transition; the segment must have a finite duration.
EventType transition_type(const Segment& segment, const Segment& next);

/// Whether the centre moves in this state.
inline bool translates(MotionState state) {
    return state == MotionState::kSliding || state == MotionState::kRolling;
}

}  // namespace carom
