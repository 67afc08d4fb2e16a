#include "font/glyphs.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace carom::render {

namespace {

// In the order of kGlyphs: polylines on a grid 4 wide and 6 high with the origin
// at the lower left, as pairs of digits x y. A blank starts a new polyline.
constexpr std::array<std::string_view, kGlyphs.size()> kStrokes{"103041453616050110",
                                                                "152620 1030",
                                                                "05163645440040",
                                                                "05163645443313 334241301001",
                                                                "30360242",
                                                                "460603334241301001",
                                                                "453616050110304142331302",
                                                                "064620",
                                                                "13020110304142331304051636454433",
                                                                "011030414536160504133344",
                                                                "2020",
                                                                "2121 2424",
                                                                "0343",
                                                                "0046 1515 3131",
                                                                "0046",
                                                                "2125 0343",
                                                                "0242 0444",
                                                                "36252130",
                                                                "16252110",
                                                                "002640 1232",
                                                                "00063645443303 3342413000",
                                                                "4536160501103041",
                                                                "00062644422000",
                                                                "46060040 0333",
                                                                "460600 0333",
                                                                "45361605011030414323",
                                                                "0006 4046 0343",
                                                                "2026 1030 1636",
                                                                "4641301001",
                                                                "0006 460340",
                                                                "060040",
                                                                "0006234640",
                                                                "00064046",
                                                                "103041453616050110",
                                                                "00063645443303",
                                                                "103041453616050110 2240",
                                                                "00063645443303 2340",
                                                                "453616050413334241301001",
                                                                "0646 2620",
                                                                "060110304146",
                                                                "062046",
                                                                "0610233046",
                                                                "0046 0640",
                                                                "062346 2320",
                                                                "06460040",
                                                                "3414031222312000",
                                                                "0004 03142320 23344340",
                                                                "103041433414030110",
                                                                "36261510 0434"};

// [units] Distance of the 4 x 6 glyph from the edges of its cell; it is centred in the cell.
constexpr float kMarginX = (kGlyphUnitsX - 4.0F) / 2.0F, kMarginY = (kGlyphUnitsY - 6.0F) / 2.0F;

float distance_to_piece(float x, float y, float ax, float ay, float bx, float by) {
    const float dx = bx - ax, dy = by - ay, length2 = dx * dx + dy * dy;
    float t = length2 > 0.0F ? ((x - ax) * dx + (y - ay) * dy) / length2 : 0.0F;
    t = std::clamp(t, 0.0F, 1.0F);
    const float ex = x - ax - t * dx, ey = y - ay - t * dy;
    return std::sqrt(ex * ex + ey * ey);
}

float distance_to_strokes(std::string_view strokes, float x, float y) {
    float nearest = kGlyphReach;
    const auto digit = [&](std::size_t i) { return static_cast<float>(strokes[i] - '0'); };
    for (std::size_t i = 0; i + 3 < strokes.size(); i += 2) {
        if (strokes[i] == ' ') {
            --i;  // skip only the blank
            continue;
        }
        if (strokes[i + 2] == ' ') continue;
        nearest =
            std::min(nearest, distance_to_piece(x, y, digit(i), digit(i + 1), digit(i + 2), digit(i + 3)));
    }
    return nearest;
}

}  // namespace

int glyph_index(char c) {
    std::size_t found = kGlyphs.find(c);
    if (found == std::string_view::npos)
        found = kGlyphs.find(static_cast<char>(std::toupper(static_cast<unsigned char>(c))));
    return found == std::string_view::npos ? -1 : static_cast<int>(found);
}

std::vector<std::uint8_t> glyph_atlas() {
    constexpr int kWidth = kGlyphColumns * kGlyphWidth, kHeight = kGlyphRows * kGlyphHeight;
    std::vector<std::uint8_t> atlas(std::size_t{kWidth} * kHeight, 0);
    for (std::size_t cell = 0; cell < kStrokes.size(); ++cell) {
        const int column = static_cast<int>(cell) % kGlyphColumns,
                  row = static_cast<int>(cell) / kGlyphColumns;
        for (int ty = 0; ty < kGlyphHeight; ++ty) {
            for (int tx = 0; tx < kGlyphWidth; ++tx) {
                const float x = (static_cast<float>(tx) + 0.5F) * kGlyphUnitsX / kGlyphWidth - kMarginX;
                const float y =
                    kGlyphUnitsY - (static_cast<float>(ty) + 0.5F) * kGlyphUnitsY / kGlyphHeight - kMarginY;
                const float near = 1.0F - distance_to_strokes(kStrokes[cell], x, y) / kGlyphReach;
                const std::size_t texel = static_cast<std::size_t>(row * kGlyphHeight + ty) * kWidth +
                                          static_cast<std::size_t>(column * kGlyphWidth + tx);
                atlas[texel] = static_cast<std::uint8_t>(std::lround(255.0F * near));
            }
        }
    }
    return atlas;
}

float glyph_nearness(const std::vector<std::uint8_t>& atlas, int cell, float x, float y) {
    const int column = cell % kGlyphColumns, row = cell / kGlyphColumns;
    const float across = (static_cast<float>(column) + x) * kGlyphWidth - 0.5F,
                down = (static_cast<float>(row) + y) * kGlyphHeight - 0.5F;
    const auto texel = [&](int i, int j) {
        i = std::clamp(i, 0, kGlyphColumns * kGlyphWidth - 1);
        j = std::clamp(j, 0, kGlyphRows * kGlyphHeight - 1);
        return static_cast<float>(atlas[static_cast<std::size_t>(j) * kGlyphColumns * kGlyphWidth +
                                        static_cast<std::size_t>(i)]) /
               255.0F;
    };
    const int i = static_cast<int>(std::floor(across)), j = static_cast<int>(std::floor(down));
    const float u = across - static_cast<float>(i), v = down - static_cast<float>(j);
    return (1.0F - v) * ((1.0F - u) * texel(i, j) + u * texel(i + 1, j)) +
           v * ((1.0F - u) * texel(i, j + 1) + u * texel(i + 1, j + 1));
}

}  // namespace carom::render
