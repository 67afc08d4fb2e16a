// Smooths the edges of the table in a picture that was drawn with one sample per pixel.
#pragma once

#include <vector>

#include "carom/render/image.h"
#include "draw/drawn_balls.h"
#include "draw/table_edges.h"
#include "draw/view.h"

namespace carom::render {

/// Projects every edge, and gives each pixel that it cuts the colour of the far side in exact proportion to
/// the area beyond the edge, in linear light (after E. Persson, geometric post-process antialiasing, 2011).
/// An edge counts only where the fourth channel of the picture shows its faces, so that it is not hidden.
/// `skip`: boxes that are left alone.
void smooth_edges(Image& image, const std::vector<TableEdge>& edges, const View& view,
                  const std::vector<PixelBox>& skip);

}  // namespace carom::render
