// The surfaces of balls as pictures that are wrapped around a sphere.
#include "carom/render/ball_texture.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "draw/skin.h"

namespace carom::render {

Image ball_texture(const BallStyle& style, int width) {
    using namespace lanes;
    const std::vector<std::uint8_t> atlas = style.number > 0 ? glyph_atlas() : std::vector<std::uint8_t>{};
    const auto& c = style.color;
    const bool bright = look::is_bright(c[0] * c[0], c[1] * c[1], c[2] * c[2]);
    const Skin skin({{all(c[0]), all(c[1]), all(c[2])},
                     vec(bright ? look::kRedDot : look::kPaleDot),
                     vec(look::kIvory),
                     number(look::kInkOnScreen)},
                    style.pattern, style.number, {0.0F, 0.0F, 0.0F, 1.0F}, atlas);
    Image image;
    image.resize({width, width / 2});
    const float step = std::numbers::pi_v<float> / static_cast<float>(image.size.height);
    std::size_t at = 0;
    for (int j = 0; j < image.size.height; ++j) {
        const float theta = (static_cast<float>(j) + 0.5F) * step;
        for (int i = 0; i < width; ++i) {
            const float phi = (static_cast<float>(i) + 0.5F) * step;
            Floats shine;
            const Vec color = skin.albedo({all(std::cos(theta)), all(std::sin(theta) * std::cos(phi)),
                                           all(std::sin(theta) * std::sin(phi))},
                                          all(step), shine);
            for (const Floats& part : {color.x, color.y, color.z})
                image.rgbx[at++] = static_cast<std::uint8_t>(std::lround(255.0F * part[0]));
            image.rgbx[at++] = 255;
        }
    }
    return image;
}

}  // namespace carom::render
