// Weights of the value of a position, by the features of Potting::features(). Written by
// lab/measure/player_fit.py.
#pragma once

#include <array>

namespace carom::games::detail {

// clang-format off
inline constexpr std::array<double, 6> kWorthEightBall = {0.100, 2.600, 4.600, 0.200, 0.716, 0.081};
inline constexpr std::array<double, 6> kWorthRotation = {0.100, 2.600, 4.600, 0.200, 0.716, 0.081};
// clang-format on

}  // namespace carom::games::detail
