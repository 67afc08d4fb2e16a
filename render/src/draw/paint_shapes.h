// The cue, and the lines and boxes of an overlay, painted over a picture of the table.
#pragma once

#include <cstdint>
#include <vector>

#include "carom/render/draw_list.h"
#include "draw/canvas.h"
#include "draw/drawn_balls.h"

namespace carom::render {

/// Paints a line where the table does not hide it. @param box pixels that it may cover
/// @param origin of the coordinates of the table mesh (TableMesh::origin)
void paint_line(const Canvas& canvas, const DrawLine& line, const PixelBox& box, const Vec2& origin);

/// As above for a cue and its shadow on the cloth.
void paint_cue(const Canvas& canvas, const DrawCue& cue, const PixelBox& box, const Vec2& origin);
void paint_cue_shadow(const Canvas& canvas, const DrawCue& cue, const PixelBox& box, const Vec2& origin);

/// Whether a ball is nearer to the eye than the part of the cue that is nearest to it.
bool is_before(const DrawnBall& ball, const DrawCue& cue, const View& view, const Vec2& origin);

/// Paints a filled rectangle or a character. @param glyphs the atlas of glyph_atlas()
void paint_box(const Canvas& canvas, const DrawBox& box, const PixelBox& pixels,
               const std::vector<std::uint8_t>& glyphs);

/// Darkens the surroundings of a ball: the cloth, and cushions and wood if they are near.
void paint_shadow(const Canvas& canvas, const DrawnBall& ball);

/// Paints a ball. @param glyphs the atlas of glyph_atlas(), for its number
void paint_ball(const Canvas& canvas, const DrawnBall& ball, const std::vector<std::uint8_t>& glyphs);

}  // namespace carom::render
