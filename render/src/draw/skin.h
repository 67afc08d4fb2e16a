// The surface of a ball, four places at a time, for frames and for textures.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "carom/render/draw_list.h"
#include "carom/render/look.h"
#include "draw/lanes.h"
#include "font/glyphs.h"

namespace carom::render::lanes {

inline Floats number(double x) {
    return all(static_cast<float>(x));
}
inline Vec vec(const look::Color& c) {
    return {number(c[0]), number(c[1]), number(c[2])};
}

// Coverage: 1 inside. x increases outwards; w is the width of a pixel in the same unit.
inline Floats inside(Floats x, Floats w) {
    return clamp(0.5F - x / w, 0.0F, 1.0F);
}

/// The colours of one ball in the form in which they are mixed: reflectances or screen values.
struct SkinColors {
    Vec base, dots, ivory;
    Floats ink;
};

class Skin {
  public:
    Skin(const SkinColors& colors, BallPattern pattern, int number, const float (&orientation)[4],
         const std::vector<std::uint8_t>& glyphs)
        : colors_(colors),
          axis_{all(-orientation[0]), all(-orientation[1]), all(-orientation[2])},
          turn_(all(orientation[3])),
          pattern_(pattern),
          number_(number),
          glyphs_(glyphs) {}

    // At the normal n; w is the width of a pixel in radii. shine: how much of the lamp's mirror image is
    // visible; print must stay legible.
    Vec albedo(const Vec& n, Floats w, Floats& shine) const {
        const Vec b = n + cross3(axis_, cross3(axis_, n) + n * turn_) * all(2.0F);
        Vec base = colors_.base;
        const Vec& ivory = colors_.ivory;
        shine = all(1.0F);
        if (pattern_ == BallPattern::kStripe)
            base = mix(ivory, base, inside(abs(b.x) - number(look::kStripe), w));
        if (pattern_ == BallPattern::kDots) base = mix(base, colors_.dots, dots(b, w));
        if (pattern_ == BallPattern::kHalves)
            base = mix(base, mix(base, Vec{all(1.0F), all(1.0F), all(1.0F)}, number(look::kPaleHalf)),
                       inside(b.x, w));
        if (number_ <= 0) return base;
        // The number is at both ends of the body's z axis, upright for a camera whose right-hand side is +y.
        const Floats spot = inside(sqrt(b.x * b.x + b.y * b.y) - number(look::kSpot), w);
        if (!any(spot > 0.0F)) return base;
        base = mix(base, ivory, spot);
        const Floats ink = spot * number_ink(b.y, choose(b.z > 0.0F, -b.x, b.x), w);
        shine = 1.0F - 0.92F * ink;
        return mix(base, Vec{colors_.ink, colors_.ink, colors_.ink}, ink);
    }

  private:
    // One of the six is larger, so that a fast turn does not look like a slow one backwards.
    static Floats dots(const Vec& b, Floats w) {
        const Vec square = b * b;
        const Floats most = max(max(square.x, square.y), square.z);
        const Floats from_axis = sqrt(max(square.x + square.y + square.z - most, 0.0F));
        const Floats radius =
            choose((square.z >= most) & (b.z > 0.0F), number(look::kLargeDot), number(look::kDot));
        return inside(from_axis - radius, w);
    }

    // Coverage by the digits; x and y are in radii of the ball, upright. With two digits side by side, each
    // pixel reads one.
    Floats number_ink(Floats x, Floats y, Floats w) const {
        const bool two = number_ > 9;
        const float box_x = two ? 0.215F : 0.33F, box_y = two ? 0.41F : 0.48F;  // half a cell of the atlas
        Floats outside = all(kGlyphReach);
        const Floats place_x = (two ? choose(x < 0.0F, x + 0.192F, x - 0.192F) : x) / box_x,
                     place_y = y / box_y;
        for (int i = 0; i < kLanes; ++i) {
            if (std::abs(place_x[i]) > 1.0F || std::abs(place_y[i]) > 1.0F) continue;
            const int digit = two && x[i] < 0.0F ? number_ / 10 : number_ % 10;
            outside[i] = glyph_distance(glyphs_, digit, std::clamp(place_x[i] * 0.5F + 0.5F, 0.02F, 0.98F),
                                        1.0F - std::clamp(place_y[i] * 0.5F + 0.5F, 0.02F, 0.98F));
        }
        // The height of a cell is 9 units.
        Floats ink = inside(outside, max(w * (4.5F / box_y), 0.05F));
        ink = choose((abs(place_x) > 1.0F) | (abs(place_y) > 1.0F), all(0.0F), ink);
        if (number_ != 6 && number_ != 9) return ink;
        // A bar below the digit distinguishes 6 from 9 in every orientation.
        return max(ink, inside(max(abs(y + 0.43F) - 0.035F, abs(x) - 0.17F), w));
    }

    SkinColors colors_;
    Vec axis_;
    Floats turn_;
    BallPattern pattern_;
    int number_;
    const std::vector<std::uint8_t>& glyphs_;
};

}  // namespace carom::render::lanes
