// Checks between the events of a record: overlaps, cushions passed through, energy.
#pragma once

#include <optional>

#include "carom/engine/verify.h"

namespace carom {

/// The state of a ball at the end of the segment before `colliding`, one of its own: it enters a cluster.
BallState entering(const Record& record, std::size_t ball, const Segment& colliding);

/// Whether a cluster moves both balls at time t, or would have if one of them had not met something else
/// before its end: until then they may still overlap.
bool share_cluster(const Record& record, std::size_t one, std::size_t other, double t);

/// [J/kg] Energy of a ball, divided by the mass in [balls]; a ball in a pocket has none.
double ball_energy(const Record& record, int ball, const BallState& state);

/// [J/kg] The rounding of the heights may change the energy of all balls together by this.
double height_rounding(const Record& record);

/// [J/kg] What ball_energy() misses of balls that run along a round wall, in all: between two moments their
/// velocity goes straight from one to the other, and in truth it turns.
double chord_energy(const Record& record, double t);

/// Checks the start, the quarters and the middle of every piece of motion between two changes of any segment,
/// and so also inside the intervals of resting contacts. Laws "U3" and "U4". A centre that crosses a cushion
/// is found exactly, at any speed.
/// @param energy  whether energy must never rise
std::optional<Violation> verify_between(const Record& record, const Plan& plan, bool energy);

}  // namespace carom
