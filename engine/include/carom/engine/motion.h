// The parameters of a ball's motion between events, and its velocities.
#pragma once

#include "carom/engine/vec.h"

namespace carom {

/// Velocity of the centre [m/s] and angular velocity [rad/s] of one ball.
struct Velocities {
    Vec3 v, w;
};

/// [m R^2] Moment of inertia of a solid ball about its centre.
inline constexpr double kInertia = 0.4;

/// [J/kg] Kinetic energy of a ball, per mass. The vectors may be planar.
template <class V, class W>
double kinetic_energy(const V& v, const W& w, double R) {
    return 0.5 * (v.squaredNorm() + kInertia * R * R * w.squaredNorm());
}

/// One ball's frictions as accelerations.
struct MotionParams {
    double R;
    double slide;  ///< mu_s g [m/s^2]
    double roll;   ///< mu_r g
    double spin;   ///< 5 mu_sp g / (2 R) [rad/s^2]
    // An effect that the plan skips is not computed.
    bool sliding = true;     ///< some ball can slip on a cloth with friction
    bool rolling = true;     ///< some ball can roll on a cloth that slows it
    bool spin_decay = true;  ///< some ball can have vertical spin that decays
    double gravity = 0.0;    ///< [m/s^2] of balls that fall
    bool rolls = true;       ///< a puck slides and never rolls
};
}  // namespace carom
