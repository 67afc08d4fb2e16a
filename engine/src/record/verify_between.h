// Checks between the events of a record: overlaps, penetrated cushions, energy.
#pragma once

#include <optional>

#include "carom/engine/verify.h"

namespace carom {

/// The state in which a ball enters a cluster: at the end of the segment before `colliding`, one of its own.
BallState entering(const Record& record, std::size_t ball, const Segment& colliding);

/// [J/kg] Energy of a ball, divided by the mass in [balls]; a ball in a pocket has none.
double ball_energy(const Record& record, int ball, const BallState& state);

/// [J/kg] Possible change of the total energy by the rounding of the heights.
double height_rounding(const Record& record);

/// [J/kg] Total energy that ball_energy() misses of balls that run along a round wall: between two instants
/// their velocity is interpolated linearly, while in truth it turns.
double chord_energy(const Record& record, double t);

/// Checks the start, the quarters and the middle of every piece of motion between two changes of any segment,
/// and so also inside the intervals of resting contacts. Laws "U3" and "U4". A centre that crosses a cushion
/// is found exactly, at any speed.
/// @param energy  whether energy must never rise
std::optional<Violation> verify_between(const Record& record, const Plan& plan, bool energy);

}  // namespace carom
