// Lines and boxes of the overlays.
#pragma once

#include <optional>

#include "carom/render/draw_list.h"

namespace carom::render {

/// Adds the selected overlays at time t [s]. cost: this frame's, for the margin bar.
void add_overlay(DrawList& list, const Record& record, const Overlay& overlay, double t,
                 std::optional<FrameBudget> cost);

void add_clock(DrawList& list, double t);
/// The numbers of the table's diamonds, on its cushions.
void add_diamond_numbers(DrawList& list, const Table& table);
void add_margin_bar(DrawList& list, const FrameBudget& cost);

}  // namespace carom::render
