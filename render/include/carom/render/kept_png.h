// PNG files of successive frames, encoding only what changed.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "carom/render/kept_image.h"

namespace carom::render {

/// Encodes as 8-bit RGB. The bytes depend on the pixels alone: not on earlier images, nor on the encoder.
class KeptPng {
  public:
    KeptPng();
    ~KeptPng();
    KeptPng(KeptPng&&) noexcept;
    KeptPng& operator=(KeptPng&&) noexcept;

    /// Encodes only the pieces of the picture that may differ from the last image. `bytes` is overwritten and
    /// its memory is reused. @throws RenderError for an image without pixels
    void encode(const KeptImage& image, std::vector<std::uint8_t>& bytes);

    /// As above for an image about which nothing is known.
    void encode(const Image& image, std::vector<std::uint8_t>& bytes);

    /// The share of the last picture that was encoded anew, 0..1.
    double share() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace carom::render
