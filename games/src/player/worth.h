// Weights of the value of a position, by the features of Potting::features(). Written by
// lab/measure/player_fit.py.
#pragma once

#include <array>

namespace carom::games::detail {

inline constexpr std::array<double, 13> kWorthEightBall = {-1.6, 3.0, 0.6, 0.3, 1.2, 0.5, -0.30,
                                                           1.5,  0.0, 0.25, -0.5, 0.0, 0.0};
inline constexpr std::array<double, 13> kWorthNineBall = {1.828, 1.361, 2.124, 0.807, 1.470, -0.025, -0.007, 0.886, 0.400, -0.049, -1.568, -0.617, -2.401};
inline constexpr std::array<double, 13> kWorthTenBall = {0.981, 1.261, 2.306, 0.921, 1.185, -0.008, -0.053, 0.785, -0.159, 0.031, -0.475, -0.828, -2.032};

}  // namespace carom::games::detail
