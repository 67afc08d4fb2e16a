// What is checked between the events of a record: overlaps, cushions that are passed, energy.
#pragma once

#include <optional>

#include "carom/engine/verify.h"

namespace carom {

/// [J/kg] Energy of a ball over the mass of a ball without a mass of its own; a ball in a pocket has none.
double ball_energy(const Record& record, int ball, const BallState& state);

/// [J/kg] What the rounding of the heights may change it by, of all balls together.
double height_rounding(const Record& record);

/// Looks at the start, the quarters and the middle of every piece of motion between two changes of any
/// segment, so inside the intervals of resting contacts, too. Laws "U3" and "U4". A cushion that a centre
/// crosses is found exactly, at any speed.
/// @param energy  whether energy may never rise
std::optional<Violation> verify_between(const Record& record, const Plan& plan, bool energy);

}  // namespace carom
