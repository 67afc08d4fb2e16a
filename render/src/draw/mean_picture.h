// The mean of several pictures in linear light.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "carom/render/image.h"

namespace carom::render {

class MeanPicture {
  public:
    /// @param rgba the first of the pictures, four bytes a pixel; it becomes the mean. It must outlive this object.
    MeanPicture(std::vector<std::uint8_t>& rgba, int width)
        : rgba_(rgba), row_(static_cast<std::size_t>(width) * 4), beyond_(rgba.size(), 0.0F) {}

    /// Adds the boxes of one more picture of the same size: the same boxes each time. Elsewhere the mean is the first picture.
    void add(const std::vector<std::uint8_t>& rgba, const std::vector<PixelBox>& boxes);

    /// Turns the first picture into the mean of all: of radiance, and of alpha as it is.
    void finish();

  private:
    std::vector<std::uint8_t>& rgba_;
    std::size_t row_;            // [bytes]
    std::vector<float> beyond_;  // sum of what the others have more than the first one
    int count_ = 1;
};

}  // namespace carom::render
