// What the two halves of aim help share.
#pragma once

#include <numbers>
#include <string_view>

#include "carom/games/aim.h"

namespace carom::games::detail {

/// [degrees] Of one radian.
inline constexpr double kDegrees = 180.0 / std::numbers::pi;

inline double cross(const Vec2& a, const Vec2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// @throws std::invalid_argument where there is none
const BallStart& ball_of(const Scene& scene, std::string_view id);
const Pocket& pocket_of(const Scene& scene, std::string_view id);

/// The ways of a ball of radius R from a place into a pocket of the table; other balls are not looked at.
PocketLine line_from(const Table& table, const Pocket& pocket, const Vec2& from, double R);

}  // namespace carom::games::detail
