// A font as an atlas of distances to its outlines, which is sharp at every size.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace carom::render {

inline constexpr int kGlyphColumns = 8, kGlyphRows = 8;    ///< cells of the atlas
inline constexpr int kGlyphWidth = 24, kGlyphHeight = 36;  ///< texels of a cell
inline constexpr float kGlyphReach = 1.5F;                 ///< distance [units] at which the atlas saturates
inline constexpr float kGlyphUnitsX = 6.0F,
                       kGlyphUnitsY = 9.0F;  ///< size of a cell [units]; letters are 4 x 6, margins 1 and 1.5

/// Characters in the order of the cells.
inline constexpr std::string_view kGlyphs = "0123456789.:-%/+=()ABCDEFGHIJKLMNOPQRSTUVWXYZsmof";

/// Cell of a character (a lower-case letter without a cell gets that of its capital), or -1 for a blank.
int glyph_index(char c);

/// One byte per texel, row 0 at the top: from 255 at the distance kGlyphReach inside an outline to 0 at this
/// distance outside.
const std::vector<std::uint8_t>& glyph_atlas();

/// The distance from the outline [units], negative inside, at a place within a cell: x and y are 0..1 from
/// its upper left corner.
float glyph_distance(const std::vector<std::uint8_t>& atlas, int cell, float x, float y);

}  // namespace carom::render
