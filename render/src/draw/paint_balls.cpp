// Balls and their shadows, painted over a picture of the table.
#include "draw/paint_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "carom/render/look.h"
#include "draw/shader_numbers.h"
#include "draw/skin.h"

namespace carom::render {

namespace {

using namespace lanes;

// Screen values to radiance, as in shaders/common.glsl.
Vec from_screen(const look::Color& screen) {
    const Vec c = vec(screen);
    return c * c;
}

// The lamp, seen from a ball.
struct LampOnBalls {
    explicit LampOnBalls(const View& view)
        : height(view.lamp[2]), endless(view.lamp_endless > 0.5F), x(view.lamp[0]), y(view.lamp[1]) {
        half_x = endless ? 0.22F * height : view.lamp_half[0];
        half_y = endless ? 0.5F * height : view.lamp_half[1];
    }

    // Light on the cloth, as lamp_light() of the shaders, but from the centre of the lamp.
    Floats light_on_cloth(Floats at_x, Floats at_y) const {
        if (endless) return all(1.0F);
        const Floats dx = at_x - x, dy = at_y - y, square = (dx * dx + dy * dy) * (1.0F / (height * height));
        return 1.0F / ((1.0F + square) * sqrt(1.0F + square));
    }

    // Light on a ball, from the nearest point of the middle of the lamp, as lamp_light() of the shaders. The
    // 0.6 accounts for its size, which lights a little beyond the terminator; the square lets the light end
    // without an edge.
    Floats light(const Vec& p, const Vec& n) const {
        const auto toward = [](Floats away, float half) {
            return clamp(away, -0.6F * half, 0.6F * half) - away;
        };
        const Vec to = endless ? Vec{all(0.0F), all(0.0F), all(height)}
                               : Vec{toward(p.x - x, half_x), toward(p.y - y, half_y), height - p.z};
        const Floats inverse = inversesqrt(dot(to, to));
        const Floats facing = max((dot(n, to) * inverse + 0.6F) * (1.0F / 1.6F), 0.0F);
        return facing * facing * (height * height) * inverse * inverse;
    }

    // Share of the lamp that a mirror at p shows in direction r.
    Floats mirror(const Vec& p, const Vec& r) const {
        const Floats up = max(r.z, 0.02F), way = (height - p.z) / up;
        const Floats at_x = r.x * way + (endless ? all(0.0F) : p.x - x),
                     at_y = r.y * way + (endless ? all(0.0F) : p.y - y);
        const float blur = 0.06F * height;  // width of the edge of the lamp
        const bool lengthwise = half_y > half_x;
        const Floats along = abs(lengthwise ? at_y : at_x), across = abs(lengthwise ? at_x : at_y);
        const float length = std::max(half_x, half_y), width = std::min(half_x, half_y);
        // Three panes, with bars at a third.
        const Floats bar = abs(along - length * (1.0F / 3.0F)) - 0.045F * length;
        const Floats shown = (1.0F - smoothstep(-blur, blur, along - length)) *
                             (1.0F - smoothstep(-blur, blur, across - width)) *
                             (0.25F + 0.75F * smoothstep(-0.3F * blur, 0.3F * blur, bar));
        return choose(r.z < 0.02F, all(0.0F), shown);
    }

    float height;
    bool endless;
    float x, y, half_x = 0.0F, half_y = 0.0F;
};

// The reflections of a ball: the lamp, the cloth, the cushions around it, and the dim room above them.
struct Surroundings {
    explicit Surroundings(const View& view)
        : lamp(view),
          cloth(vec(view.cloth) * vec(view.cloth)),
          x(0.5F * (view.inner[0] + view.inner[2])),
          y(0.5F * (view.inner[1] + view.inner[3])),
          half_x(view.inner[2] - x),
          half_y(view.inner[3] - y) {}

    // Radiance at p from direction r; R: radius of the ball.
    Vec mirrored(const Vec& p, const Vec& r, Floats shine, float R) const {
        constexpr float kRail = 0.045F;  // [m] height of the rails
        // The ray passes over the edge of the table, at this height.
        const Floats to_edge =
            min(max(half_x - choose(r.x < 0.0F, x - p.x, p.x - x), 0.0F) / max(abs(r.x), 1e-4F),
                max(half_y - choose(r.y < 0.0F, y - p.y, p.y - y), 0.0F) / max(abs(r.y), 1e-4F));
        const Floats edge = p.z + r.z * to_edge, blur = 0.006F + 0.03F * to_edge;
        const auto below = [&](float level) {
            return clamp(0.5F + (level - edge) / (2.0F * blur), 0.0F, 1.0F);
        };
        // Near its contact, the cloth is in the shadow of the ball.
        const Floats to_cloth = p.z / max(-r.z, 0.02F), away = to_cloth * (1.0F / R);
        const Floats lit = lamp.light_on_cloth(p.x + r.x * to_cloth, p.y + r.y * to_cloth) *
                           (away * away / (away * away + 1.3F));
        const Floats dim = 0.035F + 0.05F * max(1.0F - r.z * 2.5F, 0.0F);
        const Vec room{dim * 1.08F, dim, dim * 0.9F};
        const Floats bright = 15.0F * shine * lamp.mirror(p, r);
        return mix(mix(room + Vec{bright, bright, bright * 0.93F}, cloth * all(0.35F), below(kRail)),
                   cloth * lit, below(0.0F));
    }

    LampOnBalls lamp;
    Vec cloth;
    float x, y, half_x, half_y;
};

// Share of the light at normal n that passes the ball's neighbours: each hides (r / d)^2 cos of the sky.
Floats past_neighbours(const BallInstance& ball, const Vec& n) {
    const float R = ball.center_radius[3];
    Floats open = all(1.0F);
    for (const auto& near : ball.near) {
        if (near[3] <= 0.0F) break;  // the nearest come first
        const Vec to{near[0] - R * n.x, near[1] - R * n.y, near[2] - R * n.z};
        const Floats inverse = inversesqrt(dot(to, to));
        const Floats hidden = R * R * inverse * inverse * max(dot(to, n) * inverse, 0.0F);
        open *= 1.0F - 0.75F * near[3] * min(hidden, 1.0F);
    }
    return open;
}

// The mirror image with the neighbours in it: spheres of one colour, lit from above.
Vec with_neighbours(Vec seen, const BallInstance& ball, const Vec& n, const Vec& r) {
    const float R = ball.center_radius[3];
    for (std::size_t i = 0; i < std::size(ball.near) && ball.near[i][3] > 0.0F; ++i) {
        const Vec to{ball.near[i][0] - R * n.x, ball.near[i][1] - R * n.y, ball.near[i][2] - R * n.z};
        const Floats along = dot(to, r), miss2 = max(dot(to, to) - along * along, 0.0F);
        const Floats cover =
            choose(along > 0.0F, clamp((R - sqrt(miss2)) * (6.0F / R) + 0.5F, 0.0F, 1.0F), all(0.0F));
        if (!any(cover > 0.0F)) continue;
        const Floats up = (r.z * (along - sqrt(max(R * R - miss2, 0.0F))) - to.z) * (1.0F / R);
        const Floats light = 0.1F + 0.4F * max(up, 0.0F);
        seen = mix(
            seen,
            Vec{ball.near_color[i][0] * light, ball.near_color[i][1] * light, ball.near_color[i][2] * light},
            cover * ball.near[i][3]);
    }
    return seen;
}

// Below the cloth, light comes only through the mouth of the pocket, as on its wall.
Floats light_in_pocket(Floats z) {
    Floats fade{};
    for (int i = 0; i < kLanes; ++i) fade[i] = std::exp(std::min(z[i], 0.0F) / 0.035F);
    return 0.06F + (1.0F - 0.06F) * fade;
}

// On cushions and wood, which face any direction: a soft darkening around the ball, down to the cloth.
void paint_shadow_beside(const Canvas& canvas, const DrawnBall& ball, float strength) {
    const float *center = ball.instance.center_radius, *eye = canvas.view().eye;
    const Vec from_ball{all(eye[0] - center[0]), all(eye[1] - center[1]), all(eye[2] - center[2])};
    const float eye_z = eye[2], per_radius = 1.0F / center[3];
    canvas.each(ball.beside, [=, background = canvas.background(), brush = canvas.brush()](
                                 std::size_t first, int count, const Vec& ray) {
        const Vec way = ray * background.distance(first, count), away = (from_ball + way) * all(per_radius);
        const Floats near = clamp(1.0F - (dot(away, away) - 1.0F) * (1.0F / 3.4F), 0.0F, 1.0F);
        if (!any(near > 0.0F)) return;
        const Floats dark = 0.45F * near * near * smoothstep(0.0F, 0.1F, (eye_z + way.z) * per_radius) *
                            (1.0F - background.cloth(first, count));
        brush.darken(first, count, dark * strength);
    });
}

}  // namespace

void paint_shadow(const Canvas& canvas, const DrawnBall& ball) {
    const auto place = static_cast<BallPlace>(std::lround(ball.instance.pattern[1]));
    if (place == BallPlace::kPocket) return;
    const View& view = canvas.view();
    const float *center = ball.instance.center_radius, R = center[3], per_radius = 1.0F / R;
    const float strength = std::clamp(center[2] / R, 0.0F, 1.0F);  // a falling ball has no shadow left
    // From a place d radii from the point below the centre, which is L radii above the cloth, the ball hides
    // the slopes of directions a (towards it) and b (across) for which (a d + L)^2 >= (a^2 + b^2 + 1) K^2
    // with K^2 = d^2 + L^2 - 1, and the lamp is a rectangle of slopes.
    const float L = std::max(center[2] / R, 1.0F), over = L * L - 1.0F;
    const LampSlopes lamp = ball.instance.lamp;
    const float lateral =
        std::min(1.0F, 1.0F / std::sqrt(std::max(over, 1e-9F)) / std::max(lamp.half_x, lamp.half_y));
    const float beyond_x = std::max(std::abs(lamp.x) - lamp.half_x, 0.0F),
                beyond_y = std::max(std::abs(lamp.y) - lamp.half_y, 0.0F);
    // As lit() of the shaders divides the light between the lamp and the room.
    const float of_lamp = 1.05F * std::pow(1.0F + beyond_x * beyond_x + beyond_y * beyond_y, -1.5F);
    const float share = strength * of_lamp / (of_lamp + 0.16F) * lateral,
                of_room = 0.35F * strength / (L * L);
    const float eye_z = view.eye[2], from_x = view.eye[0] - center[0], from_y = view.eye[1] - center[1];
    const float reach = 1.0F / (static_cast<float>(shaders::kShadowReach) * L);
    const bool plain = ball.plain;
    canvas.each(ball.shadow, [=, background = canvas.background(), brush = canvas.brush()](
                                 std::size_t first, int count, const Vec& ray) {
        const Floats way = -eye_z / ray.z;  // to the plane of the cloth
        const Floats px = (ray.x * way + from_x) * per_radius, py = (ray.y * way + from_y) * per_radius;
        const Floats d2 = px * px + py * py, inverse = inversesqrt(max(d2, 0.0025F)), d = d2 * inverse;
        const Floats ux = -px * inverse, uy = -py * inverse;
        const Floats a = ux * lamp.x + uy * lamp.y, b = uy * lamp.x - ux * lamp.y;
        const Floats half_a = abs(ux) * lamp.half_x + abs(uy) * lamp.half_y,
                     half_b = abs(uy) * lamp.half_x + abs(ux) * lamp.half_y;
        const Floats root = sqrt(d2 + over);
        const Floats low =
            (d2 - 1.0F) / (d * L + root) + (b * b + half_b * half_b * (1.0F / 3.0F)) * d * (0.5F / L);
        Floats high = a + half_a;
        if (over > 0.0F) high = min(high, (d * L + root) * (1.0F / over));
        const Floats part = clamp((high - max(low, a - half_a)) * (0.5F / half_a), 0.0F, 1.0F);
        const Floats near = max(1.0F - d2 * reach * reach, 0.0F);
        const Floats keep =
            (1.0F - share * part * part * (3.0F - 2.0F * part)) * (1.0F - of_room * near * near * near);
        if (!any(keep < 0.998F)) return;
        Floats dark = 1.0F - sqrt(keep);  // of the screen value
        dark = choose(way > 0.0F, dark, all(0.0F));
        if (!plain) dark *= background.cloth(first, count);
        brush.darken(first, count, dark);
    });
    if (place == BallPlace::kCushion) paint_shadow_beside(canvas, ball, strength);
}

void paint_ball(const Canvas& canvas, const DrawnBall& ball, const std::vector<std::uint8_t>& glyphs) {
    const View& view = canvas.view();
    const float* center = ball.instance.center_radius;
    const float R = center[3];
    const Vec middle{all(center[0]), all(center[1]), all(center[2])}, oc = middle - vec(view.eye);
    const float* up = view.up_scaled;
    const float pixel_size = 2.0F * std::sqrt(up[0] * up[0] + up[1] * up[1] + up[2] * up[2]) / view.size[1];
    const Surroundings around(view);
    const float* c = ball.instance.color_number;
    const Skin skin({{all(c[0]), all(c[1]), all(c[2])},
                     from_screen(look::is_bright(c[0], c[1], c[2]) ? look::kRedDot : look::kPaleDot),
                     from_screen(look::kIvory),
                     number(look::kInk)},
                    static_cast<BallPattern>(std::lround(ball.instance.pattern[0])),
                    static_cast<int>(std::lround(c[3])), ball.instance.orientation, glyphs);
    const bool sunk = center[2] < 0.999F * R;
    const bool plain = ball.plain;
    const BallInstance instance = ball.instance;
    canvas.each(ball.body, [=, background = canvas.background(), brush = canvas.brush()](
                               std::size_t first, int count, const Vec& ray) {
        const Floats per_depth = inversesqrt(dot(ray, ray));
        const Vec dir = ray * per_depth;
        // Foot of the perpendicular from the centre to the ray, which avoids the difference of large squares.
        const Floats along = dot(dir, oc);
        const Vec perpendicular = dir * along - oc;
        const Floats miss2 = dot(perpendicular, perpendicular), miss = sqrt(miss2);
        const Floats pixel = pixel_size * along * per_depth;
        // Over one and a half pixels: an edge of one pixel still shows its steps.
        Floats cover = smoothstep(-0.75F, 0.75F, (R - miss) / pixel);
        if (!any(cover > 0.0F)) return;
        const Floats rise = sqrt(max(R * R - miss2, 0.0F));
        // inside: length R; outside: the distance of the ray from the centre
        const Vec n = (perpendicular - dir * rise) * (1.0F / max(miss, R));
        const Vec p = middle + n * all(R);
        if (!plain) cover *= background.seen(first, count, (along - rise) * per_depth - 0.001F);

        const Floats toward = -dot(n, dir), facing = max(toward, 0.08F);
        Floats shine;
        const Vec base = skin.albedo(n, pixel / (R * (1.0F + (facing - 1.0F) * 0.6F)), shine);
        // Light: the lamp, the dim room above, and the reflection of the cloth from below.
        const Floats under = 0.5F - 0.5F * n.z;
        const Floats above = around.lamp.light(p, n) + 0.20F * (1.0F - under), below = 0.75F * under * under;
        const Floats open = (1.0F - 0.45F * smoothstep(0.55F, 1.0F, under)) * past_neighbours(instance, n);
        Vec shade = base * (Vec{above, above, above} + around.cloth * below) * open;
        // Polish mirrors more at grazing angles.
        const Floats grazing = 1.0F - max(toward, 0.0F), grazing2 = grazing * grazing;
        const Floats fresnel = 0.05F + 0.95F * grazing2 * grazing2 * grazing;
        const Vec mirrored = dir + n * (2.0F * toward);
        shade = shade + with_neighbours(around.mirrored(p, mirrored, shine, R), instance, n, mirrored) *
                            (fresnel * (0.4F + 0.6F * open));
        if (sunk) shade = shade * light_in_pocket(p.z);
        brush.blend(first, count, {to_screen(shade.x), to_screen(shade.y), to_screen(shade.z)}, cover);
    });
}

}  // namespace carom::render
