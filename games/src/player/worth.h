// Weights of the value of a position, by the features of Potting::features(). Written by
// lab/measure/player_fit.py.
#pragma once

#include <array>

namespace carom::games::detail {

// clang-format off
inline constexpr std::array<double, 6> kWorthEightBall = {0.000, 1.133, 3.546, 0.250, 0.954, 0.175};
inline constexpr std::array<double, 6> kWorthRotation = {0.000, 3.647, 4.069, 0.250, 0.135, 0.301};
// clang-format on

}  // namespace carom::games::detail
