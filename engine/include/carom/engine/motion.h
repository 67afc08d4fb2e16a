// The parameters of a ball's motion between events.
#pragma once

namespace carom {

/// One ball's friction as accelerations, as in the equations of motion.
struct MotionParams {
    double R;
    double slide;  ///< mu_s g [m/s^2]
    double roll;   ///< mu_r g
    double spin;   ///< 5 mu_sp g / (2 R) [rad/s^2]
    // An effect that the plan skips is not computed at all.
    bool sliding = true;     ///< some ball can slip on a cloth with friction
    bool rolling = true;     ///< some ball can roll on a cloth that slows it
    bool spin_decay = true;  ///< some ball can have vertical spin that decays
    double gravity = 0.0;    ///< [m/s^2] of balls that fall
    bool rolls = true;       ///< a puck slides and never rolls
};
}  // namespace carom
