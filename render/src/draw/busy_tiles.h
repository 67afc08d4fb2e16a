// Where one sample a pixel does not tell what a pixel shows.
#pragma once

#include <cstdint>
#include <vector>

#include "carom/render/image.h"
#include "carom/render/table_mesh.h"
#include "draw/view.h"

namespace carom::render {

/// Boxes of tiles that have an edge, or a texture with contrast, or a triangle that may lie between the samples. In all other tiles a pixel
/// differs from each of its neighbours by few levels, so that no place within it differs by more.
/// @param rgba a picture with one sample in the middle of each pixel. Its alpha tells cloth from the rest.
std::vector<PixelBox> busy_tiles(const std::vector<std::uint8_t>& rgba, FrameSize size,
                                 const TableMesh& table, const View& view);

}  // namespace carom::render
