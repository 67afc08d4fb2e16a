#include "carom/render/png.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/output_file.h"
#include "carom/render/error.h"
#include "carom/render/kept_png.h"
#include "frames/png_pieces.h"

namespace carom::render {

namespace {

// libpng reports errors by longjmp; the message is stored here until it is safe to throw.
struct Failure {
    std::array<char, 200> text{};
};

void keep_error(png_structp png, png_const_charp message) {
    auto* failure = static_cast<Failure*>(png_get_error_ptr(png));
    std::snprintf(failure->text.data(), failure->text.size(), "%s", message);
    png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

void append_bytes(png_structp png, png_bytep data, png_size_t length) {
    auto* bytes = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
    bytes->insert(bytes->end(), data, data + length);
}

void flush_nothing(png_structp) {}

// Only plain data may exist between setjmp and longjmp, because longjmp skips destructors.
bool encode_rows(png_structp png, png_infop info, const Image& image, int level) {
    if (setjmp(png_jmpbuf(png))) return false;
    const auto width = static_cast<png_uint_32>(image.size.width),
               height = static_cast<png_uint_32>(image.size.height);
    png_set_IHDR(png, info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    png_set_compression_level(png, level);
    png_set_compression_buffer_size(png, 256 * 1024);
    png_write_info(png, info);
    png_set_filler(png, 0, PNG_FILLER_AFTER);  // drops the fourth channel; must follow png_write_info()
    for (png_uint_32 y = 0; y < height; ++y)
        png_write_row(png, image.rgbx.data() + std::size_t{4} * y * width);
    png_write_end(png, info);
    return true;
}

}  // namespace

void encode_png(const Image& image, int level, std::vector<std::uint8_t>& bytes) {
    Failure failure;
    bytes.clear();
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure, keep_error, ignore_warning);
    png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
    if (info == nullptr) {
        png_destroy_write_struct(&png, nullptr);
        throw RenderError(
            "libpng cannot start: it is out of memory, or not the version that carom was built with");
    }
    png_set_write_fn(png, &bytes, append_bytes, flush_nothing);
    const bool good = encode_rows(png, info, image, level);
    png_destroy_write_struct(&png, &info);
    if (!good) throw RenderError(std::string("libpng cannot encode the frame: ") + failure.text.data());
}

void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes) {
    try {
        OutputFile file(path);
        file.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        file.commit();
    } catch (const std::runtime_error& error) {
        throw RenderError(error.what());
    }
}

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
