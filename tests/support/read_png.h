// Pictures back from their files.
#pragma once

#include <png.h>

#include <stdexcept>
#include <string>

#include "carom/render/image.h"

namespace carom::render_test {

/// The pixels of a PNG file, its fourth channel 0xFF. Throws where it cannot be read.
inline render::Image read_png(const std::string& path) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    render::Image image;
    if (png_image_begin_read_from_file(&png, path.c_str()) != 0) {
        png.format = PNG_FORMAT_RGBA;
        image.resize({static_cast<int>(png.width), static_cast<int>(png.height)});
        png_image_finish_read(&png, nullptr, image.rgbx.data(), 0, nullptr);
    }
    if (PNG_IMAGE_FAILED(png)) throw std::runtime_error(path + ": " + png.message);
    for (std::size_t i = 3; i < image.rgbx.size(); i += 4) image.rgbx[i] = 0xFF;
    return image;
}

}  // namespace carom::render_test
