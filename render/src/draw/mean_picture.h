// The mean of several pictures in linear light, in a part of a picture.
#pragma once

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

}  // namespace carom::render
