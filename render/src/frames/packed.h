// Frames without compression; only what changed is converted.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "carom/render/kept_image.h"

namespace carom::render {

/// Packed RGB rows, top row first.
class PackedRgb {
  public:
    const std::vector<std::uint8_t>& pack(const KeptImage& image);
    double share() const { return share_; }  ///< of the last converted picture, 0..1

  private:
    ChangedBoxes changed_;
    std::vector<std::uint8_t> bytes_;
    double share_ = 0.0;
};

/// A frame of a Y4M stream: a line, the luma of every pixel, and two chroma values for every square of 2 x 2
/// pixels. Colours as in ITU-R BT.709, limited range (16 to 235, and 16 to 240); a square has the mean of its
/// pixels.
class PackedYuv {
  public:
    const std::vector<std::uint8_t>& pack(const KeptImage& image);
    double share() const { return share_; }

  private:
    ChangedBoxes changed_;
    std::vector<std::uint8_t> bytes_;
    double share_ = 0.0;
};

}  // namespace carom::render
