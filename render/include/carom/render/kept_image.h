// Pixels that a renderer keeps up to date.
#pragma once

#include <memory>
#include <vector>

#include "carom/render/image.h"

namespace carom::render {

struct DrawnPicture;

/// An image that only a renderer writes to and that records its contents: reading the next frame into it
/// copies only the pixels that may differ. It is not bound to one renderer.
class KeptImage {
  public:
    const Image& image() const { return image_; }

  private:
    friend class Renderer;
    friend class ChangedBoxes;
    Image image_;
    std::shared_ptr<const DrawnPicture> shows_;
};

/// For encoders of successive images: the parts in which an image may differ from the previous one.
class ChangedBoxes {
  public:
    /// Boxes outside which the image equals that of the last call; the whole image if nothing is known.
    std::vector<PixelBox> next(const KeptImage& image);

    /// As above for an image with any contents; the next call cannot compare with it.
    std::vector<PixelBox> next(const Image& image);

  private:
    FrameSize size_{0, 0};
    std::shared_ptr<const DrawnPicture> shows_;
};

}  // namespace carom::render
