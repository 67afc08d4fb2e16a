// Finds the parts of a picture that need more than one sample per pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "carom/render/image.h"
#include "carom/render/table_mesh.h"
#include "draw/view.h"

namespace carom::render {

/// Boxes outside which one sample in the middle of a pixel is as good as many: no edge or line of the table
/// passes within a pixel, and each pixel differs from its neighbours by few levels. (Walls that cut into each
/// other, borders of holes and grain show by their contrast.)
/// @param rgba a picture with one such sample, whose alpha distinguishes cloth from the rest.
std::vector<PixelBox> busy_tiles(const std::vector<std::uint8_t>& rgba, FrameSize size,
                                 const TableMesh& table, const View& view);

}  // namespace carom::render
