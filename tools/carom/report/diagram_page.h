// A page drawn by cairo, in any of the formats of diagrams.
#pragma once

#include <cairo.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "report/diagram.h"

namespace carom::tools {

/// Draws the page, white before. @return its width and height [points]
using PaintPage = std::function<std::pair<double, double>(cairo_t* cr)>;

/// @param format  one of kDiagramFormats  @return the file's bytes  @throws std::runtime_error
std::string cairo_page(const std::string& format, const PaintPage& paint);

/// The drawing of draw_diagram. @return its width and height [points]
std::pair<double, double> paint_diagram(cairo_t* cr, const std::vector<DiagramShot>& shots,
                                        const DiagramStyle& style);

}  // namespace carom::tools
