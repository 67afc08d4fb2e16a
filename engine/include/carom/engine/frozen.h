// Whether a ball was driven to a cushion, as games and sweeps define it.
#pragma once

#include <span>

#include "carom/engine/record.h"

namespace carom {

/// The farthest that a ball gets in the direction `along` (a unit vector) until `time`: the largest along *
/// position [m].
/// @param segments  of the ball; must include all that begin before `time`
double farthest(std::span<const Segment> segments, const Vec2& along, double time);

/// Whether a ball that hits a cushion or a jaw has touched it since the start. Such a contact
/// does not count as driven to the cushion.
/// @param segments  of the ball
/// @param R  its radius [m]
bool still_frozen(const Table& table, const Hit& hit, std::span<const Segment> segments, double R);

}  // namespace carom
