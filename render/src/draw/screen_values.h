// Radiance and the eight bits of a screen: to_screen() of shaders/common.glsl and its inverse, in C++.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace carom::render {

/// The radiance of every value of a channel.
inline const std::array<float, 256>& radiance_of_screen() {
    static const std::array<float, 256> kLinear = [] {
        std::array<float, 256> linear{};
        for (std::size_t i = 0; i < linear.size(); ++i) {
            const double screen = std::min(static_cast<double>(i), 254.5) / 255.0, square = screen * screen;
            linear[i] = static_cast<float>(square <= 0.5 ? square : std::sqrt(0.5 / (1.0 - square)) - 0.5);
        }
        return linear;
    }();
    return kLinear;
}

inline std::uint8_t screen_of_radiance(float linear) {
    const float over = 1.0F + std::max(linear - 0.5F, 0.0F);
    const float square = std::min(linear, 0.5F) + 0.5F - 0.5F / (over * over);
    constexpr float kToNearest = 0.5F;  // std::lround would be a call per channel
    return static_cast<std::uint8_t>(255.0F * std::sqrt(square) + kToNearest);
}

}  // namespace carom::render
