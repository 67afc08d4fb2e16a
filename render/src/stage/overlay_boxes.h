// Panels of the overlays: text and bars on top of the picture.
#pragma once

#include "carom/render/draw_list.h"

namespace carom::render {

void add_clock(DrawList& list, double t);
void add_margin_bar(DrawList& list, const FrameBudget& cost);

}  // namespace carom::render
