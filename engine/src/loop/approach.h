// How a ball comes to what it touches.
#pragma once

#include "contact/contact.h"
#include "loop/balls.h"

namespace carom {

/// A ball at a contact, and how fast and how hard it is driven into it.
struct Approach {
    Contact contact;
    Vec2 n;            ///< unit, from the ball to the other one or into the table's part
    double v_n = 0.0;  ///< [m/s] closing speed
    double a_c = 0.0;  ///< [m/s^2] at which it grows
};

/// Of two balls that touch.
Approach approach_of(const Balls& balls, int one, int two);

/// [m/s^2] At which the gap of two balls would close in these motions: by what ends a bounce, after an impact.
/// Before it, slow balls that roll are braked, and seem to part.
double closing_acceleration(const Vec2& n, const Segment& one, const Segment& two);

/// Coefficient of friction of two balls that touch, at the slip that they have now.
double pair_friction(const Plan& plan, const Balls& balls, int one, int two);

}  // namespace carom
