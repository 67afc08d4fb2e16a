// PNG files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "carom/render/image.h"

namespace carom::render {

/// Encodes a whole picture with libpng, as 8-bit RGB without row filters. Frames are encoded by kept_png.h,
/// many times faster; this makes smaller files. level: of zlib, 0..9. `bytes` is overwritten and its memory
/// is reused. @throws RenderError
void encode_png(const Image& image, int level, std::vector<std::uint8_t>& bytes);

/// Writes to a temporary name in the same folder, then renames it to `path`. After a failure no file is left.
/// @throws RenderError naming the file
void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes);

}  // namespace carom::render
