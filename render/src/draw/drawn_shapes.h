// The cue, lines and boxes of a picture, and the pixels that they may cover.
#pragma once

#include <variant>
#include <vector>

#include "carom/render/draw_list.h"
#include "carom/render/image.h"

namespace carom::render {

struct DrawnShape {
    std::variant<DrawLine, DrawBox, DrawCue> what;
    PixelBox box;         ///< pixels that it may cover
    Vec2 from, to;        ///< the ends of a line [pixels]; for anything else, two corners of the box
    double reach = -1.0;  ///< [pixels] beyond the line between them; negative: the whole box
};

/// [m] More than the radius of a cue, and than half the width of its shadow.
inline constexpr double kCueReach = 0.016, kCueShadowReach = 0.06;

/// The cue of a list, its lines, then its boxes, in the order of drawing within each kind.
std::vector<DrawnShape> drawn_shapes(const DrawList& list);

/// Adds boxes outside which two lists of shapes look the same: those of shapes that are in only one of them,
/// or drawn in another order. A long line has several boxes.
void add_differing(const std::vector<DrawnShape>& before, const std::vector<DrawnShape>& after,
                   std::vector<PixelBox>& boxes);

}  // namespace carom::render
