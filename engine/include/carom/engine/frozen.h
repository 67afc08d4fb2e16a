// Whether a ball was driven to a cushion: games and sweeps share this definition.
#pragma once

#include <span>

#include "carom/engine/record.h"

namespace carom {

/// The farthest that a ball gets in the direction `along` (a unit vector) until `time`: the greatest along *
/// position [m].
/// @param segments  those of the ball that begin until then, or more
double farthest(std::span<const Segment> segments, const Vec2& along, double time);

/// Whether a ball that meets a cushion or a jaw in this event touched it at the start and has not left it
/// since. Such a contact does not count as driven to the cushion.
/// @param segments  those of the ball
/// @param R  its radius [m]
bool still_frozen(const Table& table, const Event& event, std::span<const Segment> segments, double R);

}  // namespace carom
