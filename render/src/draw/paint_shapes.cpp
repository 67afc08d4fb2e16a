#include "draw/paint_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "font/glyphs.h"

namespace carom::render {

namespace {

using namespace lanes;

// An end of a line: its pixel, and its distance along the view direction.
struct LineEnd {
    double x, y, depth;
};

LineEnd line_end(const View& view, const Vec3& at) {
    const float* m = view.view_projection;
    const auto row = [&](int i) {
        return double(m[i]) * at.x() + double(m[i + 4]) * at.y() + double(m[i + 8]) * at.z() +
               double(m[i + 12]);
    };
    return {row(0), row(1), row(3)};  // in clip space until to_pixels()
}

LineEnd between(const LineEnd& behind, const LineEnd& front, double depth) {
    const double share = (depth - behind.depth) / (front.depth - behind.depth);
    return {behind.x + share * (front.x - behind.x), behind.y + share * (front.y - behind.y), depth};
}

LineEnd to_pixels(const LineEnd& end, const View& view) {
    return {(end.x / end.depth * 0.5 + 0.5) * double(view.size[0]),
            (end.y / end.depth * 0.5 + 0.5) * double(view.size[1]), end.depth};
}

}  // namespace

void paint_line(const Canvas& canvas, const DrawLine& line, const PixelBox& box, const Vec2& origin) {
    const Vec3 shift(origin.x(), origin.y(), 0.0);
    LineEnd a = line_end(canvas.view(), line.a - shift), b = line_end(canvas.view(), line.b - shift);
    // The part behind the eye is clipped.
    constexpr double kNear = 0.01;
    if (!(std::max(a.depth, b.depth) >= kNear)) return;
    if (a.depth < kNear) a = between(a, b, kNear);
    if (b.depth < kNear) b = between(b, a, kNear);
    a = to_pixels(a, canvas.view());
    b = to_pixels(b, canvas.view());
    const double along_x = b.x - a.x, along_y = b.y - a.y, square = along_x * along_x + along_y * along_y;
    if (!std::isfinite(square)) return;
    const double half = 0.5 * double(line.width), reach = half + 1.0;
    const double scale = 1.0 / std::max(square, 1e-6);
    const Vec color{all(line.color[0]), all(line.color[1]), all(line.color[2])};
    const float near_a = static_cast<float>(1.0 / a.depth), near_b = static_cast<float>(1.0 / b.depth);
    const Canvas::Background background = canvas.background();
    const Canvas::Brush brush = canvas.brush();
    for (int y = box.y0; y < box.y1; ++y) {
        // In one row, a line that is not level covers little of its box.
        const double down = y + 0.5 - a.y;
        double low = box.x0, high = box.x1;
        if (std::abs(along_y) > 1e-3) {
            const double middle = a.x + down * along_x / along_y,
                         wide = reach * std::sqrt(square) / std::abs(along_y) + 1.0;
            low = std::max(low, std::floor(middle - wide));
            high = std::min(high, std::ceil(middle + wide));
        }
        if (!(low < high)) continue;
        const auto dx = static_cast<float>(along_x), dy = static_cast<float>(along_y),
                   to_row = static_cast<float>(down);
        const int end = static_cast<int>(high);
        for (int x = static_cast<int>(low); x < end; x += kLanes) {
            const Floats right = Floats{0.5F, 1.5F, 2.5F, 3.5F} + static_cast<float>(x - a.x);
            const Floats t = clamp((right * dx + to_row * dy) * static_cast<float>(scale), 0.0F, 1.0F);
            const Floats off_x = right - t * dx, off_y = to_row - t * dy;
            Floats cover =
                clamp(static_cast<float>(half) + 0.5F - sqrt(off_x * off_x + off_y * off_y), 0.0F, 1.0F) *
                line.color[3];
            if (!any(cover > 0.0F)) continue;
            const std::size_t first = canvas.index(x, y);
            const int count = std::min(kLanes, end - x);
            const Floats depth = 1.0F / mix(all(near_a), all(near_b), t);
            cover *= background.seen(first, count, depth * 0.998F - 0.002F);
            brush.blend(first, count, color, cover);
        }
    }
}

void paint_box(const Canvas& canvas, const DrawBox& box, const PixelBox& pixels,
               const std::vector<std::uint8_t>& glyphs) {
    const auto f = [](double value) { return static_cast<float>(value); };
    const float low_x = f(box.low.x()), low_y = f(box.low.y()), wide = f(box.high.x()) - low_x,
                high = f(box.high.y()) - low_y;
    const Vec color{all(box.color[0]), all(box.color[1]), all(box.color[2])};
    const Canvas::Brush brush = canvas.brush();
    for (int y = pixels.y0; y < pixels.y1; ++y) {
        const float at_y = static_cast<float>(y) + 0.5F - low_y,
                    row = std::clamp(std::min(at_y, high - at_y) + 0.5F, 0.0F, 1.0F);
        for (int x = pixels.x0; x < pixels.x1; x += kLanes) {
            const Floats at_x = Floats{0.5F, 1.5F, 2.5F, 3.5F} + (static_cast<float>(x) - low_x);
            Floats cover = clamp(min(at_x, wide - at_x) + 0.5F, 0.0F, 1.0F) * row;
            if (!any(cover > 0.0F)) continue;
            for (int i = 0; i < kLanes && box.glyph >= 0; ++i) {
                const float outside =
                    glyph_distance(glyphs, box.glyph, std::clamp(at_x[i] / wide, 0.02F, 0.98F),
                                   std::clamp(at_y / high, 0.02F, 0.98F));
                // The height of the cell is 9 units.
                cover[i] *= std::clamp(0.5F - outside * high / 9.0F, 0.0F, 1.0F);
            }
            brush.blend(canvas.index(x, y), std::min(kLanes, pixels.x1 - x), color, cover * box.color[3]);
        }
    }
}

}  // namespace carom::render
