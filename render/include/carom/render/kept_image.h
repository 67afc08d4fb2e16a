// Pixels that a renderer keeps up to date.
#pragma once

#include <memory>

#include "carom/render/image.h"

namespace carom::render {

struct DrawnPicture;

/// An image that only a renderer writes to and that records what it shows: reading the next frame into it
/// copies only the pixels that may differ. It is not bound to one renderer.
class KeptImage {
  public:
    const Image& image() const { return image_; }

  private:
    friend class Renderer;
    Image image_;
    std::shared_ptr<const DrawnPicture> shows_;
};

}  // namespace carom::render
