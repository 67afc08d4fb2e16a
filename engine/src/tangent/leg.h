// One ball between two of its events, on dual numbers: a segment of the record and its dependence on the
// inputs.
#pragma once

#include "carom/engine/record.h"
#include "tangent/inputs.h"

namespace carom::tangent {

/// Position, velocity and spin. While a ball falls, r_z is the height where the fall began, as in a Segment.
struct State {
    Dual3 r, v, w;
};

Dual2 slip_of(const State& s, const Dual& R);
/// Gives a ball the spin of rolling.
void roll(State& s, const Dual& R);

/// All numbers on which a ball's motion depends.
struct Surface {
    Dual R, gravity, slide, roll, spin;  ///< as in MotionParams
};
Surface surface_of(const Numbers& numbers, int ball);

struct Leg {
    Dual start;
    State from;
    Dual2 a, dw;
    Dual spin, gravity, R;
    Dual duration;  ///< until the ball's own transition; infinite if there is none
    MotionState state = MotionState::kStationary;
    bool rolls = false;  ///< without a slip that friction would not end

    /// @param time  since the start of the shot: a fixed number, or an event's
    State at(const Dual& time) const;
};

/// The leg of a segment that begins in this state. Its values are the record's; its derivatives are those of
/// `state`, or follow from friction if that leaves a ball no freedom (it rests or rolls).
Leg leg_of(const Segment& segment, const Dual& start, State state, const Surface& surface);

/// Position and velocity in space, also of a falling ball.
void place_in_space(const Leg& leg, State& state);

}  // namespace carom::tangent
