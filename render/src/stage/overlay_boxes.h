// Panels of the overlays: text and bars on top of the picture.
#pragma once

#include "carom/render/draw_list.h"

namespace carom::render {

void add_clock(DrawList& list, double t);
/// The numbers of the table's diamonds, on its cushions.
void add_diamond_numbers(DrawList& list, const Table& table);
void add_margin_bar(DrawList& list, const FrameBudget& cost);

}  // namespace carom::render
