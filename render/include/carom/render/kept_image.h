// Pixels that a renderer keeps up to date.
#pragma once

#include <memory>

#include "carom/render/image.h"

namespace carom::render {

struct DrawnPicture;

/// An image that only a renderer fills, and that remembers what it shows: reading the next frame into it
/// copies the pixels that may differ and no others. Any renderer may fill it.
class KeptImage {
  public:
    const Image& image() const { return image_; }

  private:
    friend class Renderer;
    Image image_;
    std::shared_ptr<const DrawnPicture> shows_;
};

}  // namespace carom::render
