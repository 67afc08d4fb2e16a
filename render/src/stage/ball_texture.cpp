// The patterns of balls as draw/paint_balls.cpp paints them, for pictures that are wrapped around a sphere.
#include "carom/render/ball_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "carom/render/look.h"
#include "font/glyphs.h"

namespace carom::render {

namespace {

using Color = std::array<float, 3>;

constexpr Color color_of(const look::Color& c) {
    return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}
constexpr Color kIvory = color_of(look::kIvory),
                kInk = color_of({look::kInkOnScreen, look::kInkOnScreen, look::kInkOnScreen});
constexpr auto kSpot = static_cast<float>(look::kSpot), kStripe = static_cast<float>(look::kStripe),
               kPaleHalf = static_cast<float>(look::kPaleHalf), kDot = static_cast<float>(look::kDot),
               kLargeDot = static_cast<float>(look::kLargeDot);

struct Place {
    float x, y, z;  // on the unit sphere, in the ball's frame
};

Color mixed(const Color& a, const Color& b, float t) {
    Color c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = a[k] + (b[k] - a[k]) * t;
    return c;
}

// The share of a texel of the width w that is inside, where x grows outwards.
float inside(float x, float w) {
    return std::clamp(0.5F - x / w, 0.0F, 1.0F);
}

// How much a digit covers of a texel; x to the right and y up, from -1 to 1 in the cell of the atlas.
float digit_ink(const std::vector<std::uint8_t>& atlas, int digit, float x, float y, float w) {
    if (std::abs(x) > 1.0F || std::abs(y) > 1.0F) return 0.0F;
    const int column = digit % kGlyphColumns, row = digit / kGlyphColumns;
    const float across = (0.5F * x + 0.5F) * kGlyphWidth - 0.5F,
                down = (0.5F - 0.5F * y) * kGlyphHeight - 0.5F;
    const auto texel = [&](int i, int j) {
        i = column * kGlyphWidth + std::clamp(i, 0, kGlyphWidth - 1);
        j = row * kGlyphHeight + std::clamp(j, 0, kGlyphHeight - 1);
        return static_cast<float>(atlas[static_cast<std::size_t>(j) * kGlyphColumns * kGlyphWidth +
                                        static_cast<std::size_t>(i)]) /
               255.0F;
    };
    const int i = static_cast<int>(std::floor(across)), j = static_cast<int>(std::floor(down));
    const float u = across - static_cast<float>(i), v = down - static_cast<float>(j);
    const float near = (1.0F - v) * ((1.0F - u) * texel(i, j) + u * texel(i + 1, j)) +
                       v * ((1.0F - u) * texel(i, j + 1) + u * texel(i + 1, j + 1));
    // The strokes are 1.3 units thick, as on the balls of rendered frames.
    return inside((1.0F - near) * kGlyphReach - 0.62F, std::max(w, 0.05F));
}

float number_ink(const std::vector<std::uint8_t>& atlas, int number, float x, float y, float w) {
    const bool two = number > 9;
    const float half_width = two ? 0.215F : 0.33F, half_height = two ? 0.41F : 0.48F;
    const float right = two ? (x < 0.0F ? x + 0.192F : x - 0.192F) : x;
    const int digit = two && x < 0.0F ? number / 10 : number % 10;
    float ink = digit_ink(atlas, digit, right / half_width, y / half_height, w * 4.5F / half_height);
    // A bar below the digit distinguishes 6 from 9 in every orientation.
    if (number == 6 || number == 9)
        ink = std::max(ink, inside(std::max(std::abs(y + 0.43F) - 0.035F, std::abs(x) - 0.17F), w));
    return ink;
}

Color pattern(const BallStyle& style, const Place& b, float w) {
    const Color& own = style.color;
    if (style.pattern == BallPattern::kStripe) return mixed(kIvory, own, inside(std::abs(b.x) - kStripe, w));
    if (style.pattern == BallPattern::kHalves)
        return mixed(own, mixed(own, {1, 1, 1}, kPaleHalf), inside(b.x, w));
    if (style.pattern != BallPattern::kDots) return own;
    const float x = std::abs(b.x), y = std::abs(b.y), z = std::abs(b.z);
    const bool z_axis = z >= x && z >= y;
    const float from_axis = z_axis ? std::hypot(x, y) : x > y ? std::hypot(y, z) : std::hypot(x, z);
    const bool bright = look::is_bright(own[0] * own[0], own[1] * own[1], own[2] * own[2]);
    const float radius = z_axis && b.z > 0.0F ? kLargeDot : kDot;
    return mixed(own, color_of(bright ? look::kRedDot : look::kPaleDot), inside(from_axis - radius, w));
}

}  // namespace

Image ball_texture(const BallStyle& style, int width) {
    const std::vector<std::uint8_t> atlas = style.number > 0 ? glyph_atlas() : std::vector<std::uint8_t>{};
    Image image;
    image.resize({width, width / 2});
    const float step = std::numbers::pi_v<float> / static_cast<float>(image.size.height);
    std::size_t at = 0;
    for (int j = 0; j < image.size.height; ++j) {
        const float theta = (static_cast<float>(j) + 0.5F) * step;
        for (int i = 0; i < width; ++i) {
            const float phi = (static_cast<float>(i) + 0.5F) * step;
            const Place b{std::cos(theta), std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi)};
            Color color = pattern(style, b, step);
            if (style.number > 0) {
                const float spot = inside(std::hypot(b.x, b.y) - kSpot, step);
                const float ink = number_ink(atlas, style.number, b.y, b.z > 0.0F ? -b.x : b.x, step);
                color = mixed(mixed(color, kIvory, spot), kInk, spot * ink);
            }
            for (const float c : color) image.rgbx[at++] = static_cast<std::uint8_t>(std::lround(255.0F * c));
            image.rgbx[at++] = 255;
        }
    }
    return image;
}

}  // namespace carom::render
