// What moves a ball between events.
#pragma once

namespace carom {

/// Of one ball: friction as accelerations, in the form that the equations of motion take.
struct MotionParams {
    double R;
    double slide;  ///< mu_s g [m/s^2]
    double roll;   ///< mu_r g
    double spin;   ///< 5 mu_sp g / (2 R) [rad/s^2]
    // What the plan leaves out is not computed at all.
    bool sliding = true;     ///< some ball can slip on a cloth with friction
    bool rolling = true;     ///< some ball can roll on a cloth that brakes it
    bool spin_decay = true;  ///< some ball can have vertical spin that decays
    double gravity = 0.0;    ///< [m/s^2] of balls that fall
};
}  // namespace carom
