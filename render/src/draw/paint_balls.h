// Balls and their shadows, painted over a picture of the table.
#pragma once

#include <cstdint>
#include <vector>

#include "draw/canvas.h"
#include "draw/drawn_balls.h"

namespace carom::render {

/// Darkens the surroundings of a ball: the cloth, and cushions and wood if they are near.
void paint_shadow(const Canvas& canvas, const DrawnBall& ball);

/// Paints a ball. @param glyphs the atlas of glyph_atlas(), for its number
void paint_ball(const Canvas& canvas, const DrawnBall& ball, const std::vector<std::uint8_t>& glyphs);

}  // namespace carom::render
