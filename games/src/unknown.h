// Draws the properties of a table that a player does not know.
#pragma once

#include <cstdint>

#include "carom/games/solve.h"

namespace carom::games::detail {

/// The scene with draw number `index` of a seed. Balls within a millimetre of another one are racked: each
/// moves in a square such that the gaps have about the standard deviation `gaps`. The others move by
/// `places`. A draw that makes no valid scene is repeated.
Scene drawn_table(const Scene& scene, const Unknown& sd, std::uint64_t seed, std::uint64_t index);

}  // namespace carom::games::detail
