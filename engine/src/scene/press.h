// Balls of a rack pressed together.
#pragma once

#include <span>
#include <vector>

#include "carom/engine/scene.h"
#include "carom/kernel/splitmix64.h"

namespace carom {

/// Moves balls of unlike size from the lattice of balls of radius R until neighbours are `gap` apart. N balls
/// have 2N - 3 relative degrees of freedom, and a rack with a ball in the middle of six others has more
/// contacts than that: each such ball leaves one contact open. Slightly different forces draw neighbours
/// together and decide which contact it is.
///
/// @param fixed   the ball that stays in place; the rack as a whole does not rotate
/// @param random  determines the forces
/// @throws std::invalid_argument if the balls do not come to rest (radii that differ by tens of percent)
void press(std::vector<Vec2>& places, std::span<const double> radii, double R, double gap, std::size_t fixed,
           SplitMix64& random);

}  // namespace carom
