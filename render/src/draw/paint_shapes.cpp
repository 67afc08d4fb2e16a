#include "draw/paint_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "draw/drawn_balls.h"
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

namespace {

using namespace lanes;

constexpr float kTip = 0.0063F, kButt = 0.0148F;  // [m] radii

struct Band {
    float end;                   // [m] from the tip
    std::array<float, 3> color;  // reflectance
};
// Chalked leather, ferrule, maple, a ring, the forearm, linen, the sleeve with two rings, and the bumper.
constexpr std::array<Band, 11> kBands{{{0.005F, {0.05F, 0.13F, 0.26F}},
                                       {0.029F, {0.83F, 0.80F, 0.72F}},
                                       {0.735F, {0.66F, 0.44F, 0.21F}},
                                       {0.750F, {0.60F, 0.58F, 0.52F}},
                                       {1.040F, {0.075F, 0.022F, 0.014F}},
                                       {1.048F, {0.72F, 0.68F, 0.58F}},
                                       {1.310F, {0.035F, 0.035F, 0.04F}},
                                       {1.318F, {0.72F, 0.68F, 0.58F}},
                                       {1.420F, {0.075F, 0.022F, 0.014F}},
                                       {1.430F, {0.72F, 0.68F, 0.58F}},
                                       {9.0F, {0.01F, 0.01F, 0.01F}}}};

// Mean reflectance of the bands over a length around a place.
std::array<float, 3> color_at(float place, float length) {
    std::array<float, 3> sum{};
    const float low = place - 0.5F * length, high = place + 0.5F * length;
    float from = -9.0F;
    for (const Band& band : kBands) {
        const float share = std::max(std::min(high, band.end) - std::max(low, from), 0.0F) / length;
        for (std::size_t k = 0; k < 3; ++k) sum[k] += share * band.color[k];
        from = band.end;
    }
    return sum;
}

Vec3 vec3(const float* v) {
    return {double(v[0]), double(v[1]), double(v[2])};
}

Vec from(const Vec3& v) {
    return {all(static_cast<float>(v.x())), all(static_cast<float>(v.y())), all(static_cast<float>(v.z()))};
}

}  // namespace

void paint_cue_shadow(const Canvas& canvas, const DrawCue& cue, const PixelBox& box, const Vec2& origin) {
    const View& view = canvas.view();
    const Vec3 tip = cue.tip - Vec3(origin.x(), origin.y(), 0.0), along = cue.butt - cue.tip;
    const auto f = [](double value) { return static_cast<float>(value); };
    const float dx = f(along.x()), dy = f(along.y()), per_square = f(1.0 / along.head<2>().squaredNorm()),
                height = f(tip.z()), rise = f(along.z()), from_x = view.eye[0] - f(tip.x()),
                from_y = view.eye[1] - f(tip.y()), eye_z = view.eye[2], opacity = cue.opacity;
    constexpr auto kWidest = f(kCueShadowReach);
    canvas.each(box, [=, background = canvas.background(), brush = canvas.brush()](
                         std::size_t first, int count, const Vec& ray) {
        const Floats way = -eye_z / ray.z;  // to the plane of the cloth
        const Floats x = ray.x * way + from_x, y = ray.y * way + from_y;
        const Floats share = clamp((x * dx + y * dy) * per_square, 0.0F, 1.0F);
        const Floats off_x = x - share * dx, off_y = y - share * dy;
        // The higher the cue, the wider and fainter its shadow.
        const Floats width = min(0.012F + 0.22F * (height + rise * share), kWidest);
        const Floats off = 1.0F - (off_x * off_x + off_y * off_y) / (width * width),
                     inside = max(off, all(0.0F));
        Floats dark = inside * inside * (0.006F / width) * opacity;
        dark = choose(way > 0.0F, dark, all(0.0F));
        if (!any(dark > 0.002F)) return;
        brush.darken(first, count, dark * background.cloth(first, count));
    });
}

bool is_before(const DrawnBall& ball, const DrawCue& cue, const View& view, const Vec2& origin) {
    const Vec3 tip = cue.tip - Vec3(origin.x(), origin.y(), 0.0), along = cue.butt - cue.tip,
               center = vec3(ball.instance.center_radius);
    const double share = std::clamp((center - tip).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (center - tip - share * along).dot(center - vec3(view.eye)) < 0.0;
}

void paint_cue(const Canvas& canvas, const DrawCue& cue, const PixelBox& box, const Vec2& origin) {
    const View& view = canvas.view();
    const Vec3 shift(origin.x(), origin.y(), 0.0), tip = cue.tip - shift, butt = cue.butt - shift;
    const Vec3 eye = vec3(view.eye), axis = (butt - tip).normalized();
    const auto length = static_cast<float>((butt - tip).norm());
    const Vec axis4 = from(axis), to_tip = from(tip - eye);
    // The lamp is above; half of the way to it the surface shines towards the eye.
    const Vec3 to_eye = (eye - 0.5 * (tip + butt)).normalized(), lamp = vec3(view.lamp);
    const Vec3 to_lamp =
        view.lamp_endless > 0.5F ? Vec3(Vec3::UnitZ()) : (lamp - 0.5 * (tip + butt)).normalized();
    const Vec light = from(to_lamp), shines = from((to_eye + to_lamp).normalized());
    const float* up = view.up_scaled;
    const float pixel_size = 2.0F * std::sqrt(up[0] * up[0] + up[1] * up[1] + up[2] * up[2]) / view.size[1];
    const float opacity = cue.opacity;
    canvas.each(box, [=, background = canvas.background(), brush = canvas.brush()](
                         std::size_t first, int count, const Vec& ray) {
        // The nearest points of the axis and of the ray: tip + s axis and eye + t ray.
        const Floats along = dot(ray, axis4), square = dot(ray, ray),
                     det = max(square - along * along, 1e-9F);
        const Floats to_axis = dot(axis4, to_tip), to_ray = dot(ray, to_tip);
        const Floats s = clamp((along * to_ray - square * to_axis) / det, 0.0F, length);
        const Floats t = (to_ray + along * s) / square;
        const Vec away = ray * t - to_tip - axis4 * s;
        const Floats radius = kTip + (kButt - kTip) / length * s, miss = sqrt(dot(away, away));
        const Floats pixel = pixel_size * t;
        Floats cover = clamp(0.5F + (radius - miss) / pixel, 0.0F, 1.0F) * opacity;
        cover = choose(t > 0.01F, cover, all(0.0F));
        if (!any(cover > 0.0F)) return;
        cover *= background.seen(first, count, t - 0.002F);
        // The normal leans from the eye to the side on which the ray passes.
        const Floats aside = min(miss / radius, 1.0F), to_eye4 = sqrt(1.0F - aside * aside);
        const Vec across = away * (1.0F / max(miss, 1e-6F)), sight = ray * inversesqrt(square),
                  facing = sight - axis4 * dot(sight, axis4);
        const Vec n = across * aside - facing * (to_eye4 * inversesqrt(max(dot(facing, facing), 1e-9F)));
        const Floats lit = 0.20F + 0.95F * max((dot(n, light) + 0.35F) * (1.0F / 1.35F), 0.0F);
        Floats shine = max(dot(n, shines), 0.0F);
        for (int i = 0; i < 5; ++i) shine *= shine;
        Vec base{};
        for (int i = 0; i < kLanes; ++i) {
            const std::array<float, 3> color = color_at(s[i], std::max(pixel[i] * 1.5F, 1e-4F));
            base.x[i] = color[0];
            base.y[i] = color[1];
            base.z[i] = color[2];
        }
        const Vec shade = base * lit + Vec{shine, shine, shine} * all(0.30F);
        brush.blend(first, count, {to_screen(shade.x), to_screen(shade.y), to_screen(shade.z)}, cover);
    });
}

}  // namespace carom::render
