// PNG files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "carom/render/image.h"

namespace carom::render {

/// Encodes as 8-bit RGB without row filters (on flat pictures faster and smaller than with them). level:
/// zlib, 0..9. `bytes` is overwritten, its memory reused. @throws RenderError
void encode_png(const Image& image, int level, std::vector<std::uint8_t>& bytes);

/// Writes to a temporary name beside `path` and renames. On failure nothing is left. @throws RenderError
/// naming the file
void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes);

}  // namespace carom::render
