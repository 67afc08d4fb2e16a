#include "carom/render/kept_png.h"

#include "frames/png_pieces.h"

namespace carom::render {

struct KeptPng::Impl {
    ChangedBoxes changed;
    PngPieces pieces;
};

KeptPng::KeptPng() : impl_(std::make_unique<Impl>()) {}
KeptPng::~KeptPng() = default;
KeptPng::KeptPng(KeptPng&&) noexcept = default;
KeptPng& KeptPng::operator=(KeptPng&&) noexcept = default;

void KeptPng::encode(const KeptImage& image, std::vector<std::uint8_t>& bytes) {
    impl_->pieces.encode(image.image(), impl_->changed.next(image), bytes);
}

void KeptPng::encode(const Image& image, std::vector<std::uint8_t>& bytes) {
    impl_->pieces.encode(image, impl_->changed.next(image), bytes);
}

double KeptPng::share() const {
    return impl_->pieces.share();
}

}  // namespace carom::render
