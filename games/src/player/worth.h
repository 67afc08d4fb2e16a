// Weights of the value of a position, by the features of Potting::features(). Written by
// lab/measure/player_fit.py.
#pragma once

#include <array>

namespace carom::games::detail {

inline constexpr std::array<double, 13> kWorthEightBall = {-1.6, 3.0, 0.6, 0.3, 1.2, 0.5, -0.30,
                                                           1.5,  0.0, 0.25, -0.5, 0.0, 0.0};
inline constexpr std::array<double, 13> kWorthNineBall = {0.0, 4.0, 4.0, 0.3, 0.0, 0.0, 0.0,
                                                          0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
inline constexpr std::array<double, 13> kWorthTenBall = {0.0, 4.0, 4.0, 0.3, 0.0, 0.0, 0.0,
                                                         0.0, 0.0, 0.0, 0.0, 0.0, 0.0};

}  // namespace carom::games::detail
