// The mean of several pictures in linear light.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace carom::render {

class MeanPicture {
  public:
    /// @param rgba the first of the pictures, four bytes a pixel; it becomes the mean. It must outlive this object.
    explicit MeanPicture(std::vector<std::uint8_t>& rgba) : rgba_(rgba), beyond_(rgba.size(), 0.0F) {}

    /// One more picture of the same size. Where it equals the first one it costs next to nothing.
    void add(const std::vector<std::uint8_t>& rgba);

    /// Turns the first picture into the mean of all: of radiance, and of alpha as it is.
    void finish();

  private:
    std::vector<std::uint8_t>& rgba_;
    std::vector<float> beyond_;  // sum of what the others have more than the first one
    int count_ = 1;
};

}  // namespace carom::render
