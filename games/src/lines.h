// What the two halves of the aiming aid share.
#pragma once

#include <string_view>

#include "carom/games/aim.h"

namespace carom::games::detail {

/// @throws std::invalid_argument if there is none
const BallStart& ball_of(const Scene& scene, std::string_view id);
const Pocket& pocket_of(const Scene& scene, std::string_view id);

/// The paths of a ball of radius R from a place into a pocket of the table; other balls are ignored.
PocketLine line_from(const Table& table, const Pocket& pocket, const Vec2& from, double R);

}  // namespace carom::games::detail
