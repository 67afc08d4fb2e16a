// Reads pictures from their files.
#pragma once

#include <png.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/render/image.h"

namespace carom::render_test {

/// The pixels of the picture that `begin` opens, with 0xFF as fourth channel. Throws if unreadable; `name` is
/// for the message.
template <class Begin>
render::Image read_png_by(const Begin& begin, const std::string& name) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    render::Image image;
    if (begin(&png) != 0) {
        png.format = PNG_FORMAT_RGBA;
        image.resize({static_cast<int>(png.width), static_cast<int>(png.height)});
        png_image_finish_read(&png, nullptr, image.rgbx.data(), 0, nullptr);
    }
    if (PNG_IMAGE_FAILED(png)) throw std::runtime_error(name + ": " + png.message);
    for (std::size_t i = 3; i < image.rgbx.size(); i += 4) image.rgbx[i] = 0xFF;
    return image;
}

inline render::Image read_png(const std::string& path) {
    return read_png_by([&](png_image* png) { return png_image_begin_read_from_file(png, path.c_str()); },
                       path);
}

inline render::Image read_png(const std::vector<std::uint8_t>& bytes) {
    return read_png_by(
        [&](png_image* png) { return png_image_begin_read_from_memory(png, bytes.data(), bytes.size()); },
        "a PNG in memory");
}

}  // namespace carom::render_test
