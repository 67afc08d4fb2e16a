// Draws the properties of a table that a player does not know.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "carom/games/solve.h"

namespace carom::games::detail {

/// The scene with draw number `index` of a seed. Balls within a millimetre of another one are racked: each
/// moves in a square such that the gaps have about the standard deviation `gaps`. The others move by
/// `places`. A draw that makes no valid scene is repeated.
Scene drawn_table(const Scene& scene, const Unknown& sd, std::uint64_t seed, std::uint64_t index);

/// The keys of a scene that differ from one drawn table to the next, and their values in one. @param resized
/// the balls whose sizes differ, too
std::vector<std::string> table_keys(const Scene& scene, const std::vector<bool>& resized);
std::vector<double> table_values(const Scene& table, const std::vector<bool>& resized);

}  // namespace carom::games::detail
