// One ball between two events: its motion in closed form, and its next transition. Source:
// docs/reference/physics.md (Leckie and Greenspan, "An event-based pool physics simulator", 2005).
#pragma once

#include "carom/engine/motion.h"
#include "carom/engine/record.h"
#include "carom/engine/scene.h"

namespace carom {

/// Slip at the cloth, u = v + w x (-R z) = (v_x - R w_y, v_y + R w_x) [m/s].
Vec2 cloth_slip(const Vec3& v, const Vec3& w, double R);

/// @param R  radius of the ball
MotionParams motion_params(const BallParams& balls, double gravity, double R);

/// The segment that starts at time t with these velocities, which determine the motion state: rolling if the
/// slip is at most kRollingUlp ulp of |v| + R |w| (the spin is then set to that of rolling), and so on.
Segment start_segment(double t, const Vec3& r, const Vec3& v, const Vec3& w, const MotionParams& params);

/// The segment of a ball that falls into a pocket at the speed `falls` [m/s]: it moves on a straight path,
/// without the cloth, until its centre is at cloth level.
/// @param r  with the (perhaps virtual) height at which the fall began: its centre is falls^2/2g lower
Segment falling_segment(double t, const Vec3& r, const Vec3& v, const Vec3& w, double falls,
                        const MotionParams& params);

/// [m/s] Downward speed of a falling ball `tau` after the start of its segment; gravity [m/s^2].
inline double fall_speed(const Segment& segment, double tau, double gravity) {
    return gravity * tau - segment.v.z();
}

/// Whether a ball of radius R is above the cloth: in flight, or in a cluster in space.
inline bool is_aloft(const Segment& s, double R) {
    return flies(s.state) || (s.state == MotionState::kColliding && (s.r.z() > R || s.v.z() > 0.0));
}

/// Position and velocity of a ball, including the height in a fall or flight, which position_at and
/// velocity_at omit.
struct Placed {
    Vec3 position, velocity;
};
inline Placed placed_at(const Segment& segment, double tau, double gravity) {
    Placed p{position_at(segment, tau), velocity_at(segment, tau)};
    if (flies(segment.state)) {
        p.position.z() = segment.r.z() + tau * (segment.v.z() - 0.5 * gravity * tau);
        p.velocity.z() = segment.v.z() - gravity * tau;
        return p;
    }
    if (segment.state != MotionState::kFalling) return p;
    const double falls = fall_speed(segment, tau, gravity);
    p.position.z() -= falls * falls / (2.0 * gravity);
    p.velocity.z() = -falls;
    return p;
}

/// The same for a ball of radius R that may have left the table: it stays where it reaches the floor.
inline Placed placed_at(const Segment& segment, double tau, double gravity, double R) {
    const double floor = until_floor(segment, R, gravity);
    if (tau < floor) return placed_at(segment, tau, gravity);
    const Vec3 there = position_at(segment, floor);
    return {Vec3(there.x(), there.y(), R - kFloorDepth), Vec3::Zero()};
}

/// The segment of a flying ball until it lands on the cloth: a parabola, without friction. r_z is at least R.
Segment airborne_segment(double t, const Vec3& r, const Vec3& v, const Vec3& w, const MotionParams& params);

/// The segment that starts at time t if balls may leave the cloth: airborne if the ball is above it or rises
/// faster than bounce_end(), otherwise as start_segment().
Segment free_segment(double t, const Vec3& r, const Vec3& v, const Vec3& w, const MotionParams& params);

/// The velocity of a flying ball when it lands: exact, even for a ball that rose from the cloth.
Vec3 landing_velocity(const Segment& segment, const MotionParams& params);

/// The segment of a ball in a cluster that lasts for `duration` and moves it by `path`. Its spin afterwards
/// is w.
Segment colliding_segment(double t, const Vec3& r, const Vec3& path, const Vec3& w, double duration);

/// Whether two balls with these segments are in the same cluster. They may overlap.
inline bool collide(const Segment& a, const Segment& b) {
    return a.state == MotionState::kColliding && b.state == MotionState::kColliding && a.start == b.start;
}

/// The segment of a ball that lies in a pocket.
Segment pocketed_segment(double t, const Pocket& pocket);

/// The ball's next transition: its state at the end of the segment, as the next segment.
Segment after_transition(const Segment& segment, const MotionParams& params);

/// The type of that transition; the segment must have a finite duration.
EventType transition_type(const Segment& segment, const Segment& next);

inline bool translates(MotionState state) {
    return state == MotionState::kSliding || state == MotionState::kRolling ||
           state == MotionState::kFalling || state == MotionState::kAirborne ||
           state == MotionState::kColliding;
}

}  // namespace carom
