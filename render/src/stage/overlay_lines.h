// Lines and boxes of the overlays.
#pragma once

#include <optional>

#include "carom/render/draw_list.h"

namespace carom::render {

/// Adds the selected overlays at time t [s]. cost: this frame's, for the margin bar.
void add_overlay(DrawList& list, const Record& record, const Overlay& overlay, double t,
                 std::optional<FrameBudget> cost);

}  // namespace carom::render
