// Weights of the value of a position, by the features of Potting::features(). Written by
// lab/measure/player_fit.py.
#pragma once

#include <array>

namespace carom::games::detail {

// clang-format off
inline constexpr std::array<double, 13> kWorthEightBall = {-1.6, 3.0, 0.6, 0.3, 1.2, 0.5, -0.30, 1.5, 0.0, 0.25, -0.5, 0.0, 0.0};
inline constexpr std::array<double, 13> kWorthRotation = {0.830, 2.375, 4.321, -0.238, 0.441, 0.869, 0.097, -1.282};
// clang-format on

}  // namespace carom::games::detail
