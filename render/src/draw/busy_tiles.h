// Where one sample a pixel does not tell what a pixel shows.
#pragma once

#include <cstdint>
#include <vector>

#include "carom/render/image.h"
#include "carom/render/table_mesh.h"
#include "draw/view.h"

namespace carom::render {

/// Boxes outside of which one sample in the middle of a pixel is as good as many: no edge or line of the
/// table passes within a pixel, and each pixel differs from its neighbours by few levels. (A wall that cuts
/// into another one, the border of a hole and grain are seen by their contrast.)
/// @param rgba a picture with one such sample. Its alpha tells cloth from the rest.
std::vector<PixelBox> busy_tiles(const std::vector<std::uint8_t>& rgba, FrameSize size,
                                 const TableMesh& table, const View& view);

}  // namespace carom::render
