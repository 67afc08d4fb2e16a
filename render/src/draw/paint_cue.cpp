#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "draw/drawn_balls.h"
#include "draw/paint_shapes.h"

namespace carom::render {

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
