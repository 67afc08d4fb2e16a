// The mean of several pictures in linear light, in a part of a picture.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "carom/render/image.h"

namespace carom::render {

class MeanPicture {
  public:
    /// @param rgba the first picture, four bytes per pixel; it becomes the mean. It must outlive this object.
    /// @param boxes where the other pictures count, without overlap; elsewhere the mean is the first picture
    MeanPicture(std::vector<std::uint8_t>& rgba, int width, std::vector<PixelBox> boxes);

    /// Adds a picture of the same size.
    void add(const std::vector<std::uint8_t>& rgba);

    /// Turns the first picture into the mean of all: of radiance, and of the alpha values themselves.
    void finish();

  private:
    // Calls at(byte, sum) for every pixel of the boxes, with the positions of its first byte and of its sums.
    template <class At>
    void each_pixel(const At& at) const;

    std::vector<std::uint8_t>& rgba_;
    std::size_t row_;  // [bytes]
    std::vector<PixelBox> boxes_;
    std::vector<float> beyond_;  // sums of the differences from the first picture, box after box
    int count_ = 1;
};

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
