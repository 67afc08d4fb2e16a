// Weights of the value of a position, by the features of Potting::features(). Written by
// lab/measure/player_fit.py.
#pragma once

#include <array>

namespace carom::games::detail {

// clang-format off
inline constexpr std::array<double, 8> kWorthEightBall = {0.830, 2.375, 4.321, -0.238, 0.441, 0.869, 0.097, -1.282};
inline constexpr std::array<double, 8> kWorthRotation = {0.830, 2.375, 4.321, -0.238, 0.441, 0.869, 0.097, -1.282};
// clang-format on

}  // namespace carom::games::detail
