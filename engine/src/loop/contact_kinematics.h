// The motion of a ball relative to what it touches.
#pragma once

#include "contact/contact.h"
#include "loop/balls.h"

namespace carom {

/// A ball at a contact, with its closing speed and closing acceleration.
struct ContactKinematics {
    Contact contact;
    Vec2 n;            ///< unit, from the ball to the other one or into the table's part
    double v_n = 0.0;  ///< [m/s] closing speed
    double a_c = 0.0;  ///< [m/s^2] closing acceleration
};

/// The kinematics of two balls that touch.
ContactKinematics kinematics_of(const Plan& plan, const Balls& balls, int one, int two);

/// [m/s^2] Acceleration at which the gap between two balls closes during these motions. Pass the motions
/// after an impact to see whether the bounce ends: before it, slow rolling balls decelerate and seem to
/// separate.
double closing_acceleration(const Vec2& n, const Segment& one, const Segment& two);

}  // namespace carom
