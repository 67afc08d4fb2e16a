// The motion of a ball relative to its partner in a contact.
#pragma once

#include "contact/contact.h"
#include "loop/balls.h"

namespace carom {

struct ContactKinematics {
    Contact contact;
    Vec2 n;            ///< unit, from the ball to the other one or into the part
    double v_n = 0.0;  ///< [m/s] closing speed
    double a_c = 0.0;  ///< [m/s^2] closing acceleration
};

ContactKinematics kinematics_of(const Plan& plan, const Balls& balls, int one, int two);

}  // namespace carom
