// One ball between two events: closed-form motion and the next own transition. Source: physics, section 1
// (Leckie and Greenspan, "An event-based pool physics simulator", 2005).
#pragma once

#include <algorithm>
#include <cmath>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"
#include "carom/engine/scene.h"

namespace carom {

inline Vec2 planar(const Vec3& a) {
    return {a.x(), a.y()};
}

/// Length of a planar vector; no overflow, no underflow, no libm.
inline double length(const Vec2& a) {
    const double largest = std::max(std::abs(a.x()), std::abs(a.y()));
    if (largest == 0.0) return 0.0;
    // Squares stay normal numbers in this range; outside it, scale by a power of two (exact).
    if (largest > 0x1p-500 && largest < 0x1p500) return std::sqrt(a.x() * a.x() + a.y() * a.y());
    const double scale = largest < 1.0 ? 0x1p600 : 0x1p-600;
    const double x = a.x() * scale, y = a.y() * scale;
    return std::sqrt(x * x + y * y) / scale;
}

/// Slip at the cloth, u = v + w x (-R z) = (v_x - R w_y, v_y + R w_x) [m/s].
Vec2 cloth_slip(const Vec3& v, const Vec3& w, double R);

/// What moves a ball between events.
struct MotionParams {
    double R;
    double slide;  ///< mu_s g [m/s^2]
    double roll;   ///< mu_r g
    double spin;   ///< 5 mu_sp g / (2 R) [rad/s^2]
    // What the plan leaves out is not computed at all.
    bool sliding = true;     ///< some ball can slip on a cloth with friction
    bool rolling = true;     ///< some ball can roll on a cloth that brakes it
    bool spin_decay = true;  ///< some ball can have vertical spin that decays
};
/// @param R  radius of the ball
MotionParams motion_params(const BallParams& balls, double gravity, double R);
/// Of one ball, with what a plan leaves out.
MotionParams motion_params(const Plan& plan, int ball);

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
