#include "draw/paint_balls.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "carom/render/look.h"
#include "draw/shaders.h"
#include "draw/skin.h"

namespace carom::render {

namespace {

using namespace lanes;

// Screen values to radiance and back, as in shaders/common.glsl.
Vec from_screen(const look::Color& screen) {
    const Vec c = vec(screen);
    return c * c;
}
Floats to_screen(Floats c) {
    const Floats over = 1.0F + max(c - 0.5F, 0.0F);
    return sqrt(clamp(c, 0.0F, 0.5F) + 0.5F - 0.5F / (over * over));
}

// The lamp, seen from a ball.
struct LampOnBalls {
    explicit LampOnBalls(const View& view)
        : height(view.lamp[2]), endless(view.lamp_endless > 0.5F), x(view.lamp[0]), y(view.lamp[1]) {
        half_x = endless ? 0.22F * height : view.lamp_half[0];
        half_y = endless ? 0.5F * height : view.lamp_half[1];
    }

    // Light on a ball: the centre of the lamp is accurate enough. The 0.6 accounts for its size, which lights
    // a little beyond the terminator; the square lets the light end without an edge.
    Floats light(const Vec& p, const Vec& n) const {
        const Vec to = endless ? Vec{all(0.0F), all(0.0F), all(height)} : Vec{x - p.x, y - p.y, height - p.z};
        const Floats inverse = inversesqrt(dot(to, to));
        const Floats facing = max((dot(n, to) * inverse + 0.6F) * (1.0F / 1.6F), 0.0F);
        return facing * facing * (height * height) * inverse * inverse;
    }

    // Share of the lamp that a mirror at p shows in direction r.
    Floats mirror(const Vec& p, const Vec& r) const {
        const Floats up = max(r.z, 0.02F), way = (height - p.z) / up;
        const Floats at_x = r.x * way + (endless ? all(0.0F) : p.x - x),
                     at_y = r.y * way + (endless ? all(0.0F) : p.y - y);
        const float blur = 0.1F * height;  // width of the edge of the lamp
        const Floats shown = (1.0F - smoothstep(-blur, blur, abs(at_x) - half_x)) *
                             (1.0F - smoothstep(-blur, blur, abs(at_y) - half_y));
        return choose(r.z < 0.02F, all(0.0F), shown);
    }

    float height;
    bool endless;
    float x, y, half_x = 0.0F, half_y = 0.0F;
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
        const Floats dark = 0.6F * near * near * smoothstep(0.0F, 0.1F, (eye_z + way.z) * per_radius) *
                            (1.0F - background.cloth(first, count));
        brush.darken(first, count, dark * strength);
    });
}

}  // namespace

void paint_shadow(const Canvas& canvas, const DrawnBall& ball) {
    const auto place = static_cast<BallPlace>(std::lround(ball.instance.pattern[1]));
    if (place == BallPlace::kPocket) return;
    const View& view = canvas.view();
    const float *center = ball.instance.center_radius, R = center[3];
    const float strength = std::clamp(center[2] / R, 0.0F, 1.0F);  // a falling ball has no shadow left
    // A ball in the air has a wider shadow, in proportion to the height of its centre, and farther away.
    const float lift = std::max(center[2] / R, 1.0F), unit = 1.0F / (R * lift);
    // Centre of the lamp's shadow relative to the point of contact, in radii: limited to 0.65, so that the
    // whole shadow lies within the reach.
    const bool endless = view.lamp_endless > 0.5F;
    float away_x = endless ? 0.0F : (center[0] - view.lamp[0]) / (view.lamp[2] - center[2]);
    float away_y = endless ? 0.0F : (center[1] - view.lamp[1]) / (view.lamp[2] - center[2]);
    const float limit =
        std::min(1.0F, 0.65F / std::sqrt(std::max(away_x * away_x + away_y * away_y, 1e-12F)));
    away_x *= limit;
    away_y *= limit;
    constexpr auto kReach = static_cast<float>(shaders::kShadowReach);
    const float eye_z = view.eye[2], from_x = view.eye[0] - center[0], from_y = view.eye[1] - center[1];
    const float of_sky = 0.55F / (lift * lift), of_lamp = 0.55F / lift;
    const bool plain = ball.plain;
    canvas.each(ball.shadow, [=, background = canvas.background(), brush = canvas.brush()](
                                 std::size_t first, int count, const Vec& ray) {
        const Floats way = -eye_z / ray.z;  // to the plane of the cloth
        const Floats px = (ray.x * way + from_x) * unit, py = (ray.y * way + from_y) * unit;
        // Share of the sky hidden by a sphere resting on a plane: (1 + d^2)^(-3/2) at d radii from the
        // contact. The polynomial differs by less than 0.03 up to 2 radii, and reaches 0.
        const Floats near = max(1.0F - (px * px + py * py) * (1.0F / (kReach * kReach)), 0.0F);
        if (!any(near > 0.0F)) return;
        const Floats hidden = near * near * near;
        // The lamp is wide, so its shadow has no sharp edge.
        const Floats dx = px - away_x, dy = py - away_y;
        const Floats inner = max(1.0F - (dx * dx + dy * dy) * (1.0F / 3.4F), 0.0F);
        // A ball higher up hides less of the sky and of the wide lamp.
        Floats dark = (1.0F - (1.0F - hidden * of_sky) * (1.0F - inner * inner * of_lamp)) * strength;
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
    const LampOnBalls lamp(view);
    const float* c = ball.instance.color_number;
    const Skin skin({{all(c[0]), all(c[1]), all(c[2])},
                     from_screen(look::is_bright(c[0], c[1], c[2]) ? look::kRedDot : look::kPaleDot),
                     from_screen(look::kIvory),
                     number(look::kInk)},
                    static_cast<BallPattern>(std::lround(ball.instance.pattern[0])),
                    static_cast<int>(std::lround(c[3])), ball.instance.orientation, glyphs);
    const Vec cloth = from_screen(look::kCloth), dim{all(0.10F), all(0.10F), all(0.10F)};
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
        Floats cover = clamp(0.5F + (R - miss) / pixel, 0.0F, 1.0F);
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
        const Floats above = lamp.light(p, n) + 0.20F * (1.0F - under), below = 0.75F * under * under;
        const Floats open = (1.0F - 0.45F * smoothstep(0.55F, 1.0F, under)) * past_neighbours(instance, n);
        Vec shade = base * (Vec{above, above, above} + cloth * below) * open;
        // Specular reflection: a mirror image of the lamp, and of the room at grazing angles.
        const Vec r = dir + n * (2.0F * toward);
        const Floats grazing = 1.0F - max(toward, 0.0F), grazing2 = grazing * grazing;
        const Floats fresnel = 0.045F + 0.955F * grazing2 * grazing2;
        const Vec room = mix(cloth * all(0.35F), dim, smoothstep(-0.25F, 0.25F, r.z));
        const Floats bright = 11.0F * shine * lamp.mirror(p, r);
        shade = shade + (room + Vec{bright, bright, bright}) * fresnel;
        if (sunk) shade = shade * light_in_pocket(p.z);
        brush.blend(first, count, {to_screen(shade.x), to_screen(shade.y), to_screen(shade.z)}, cover);
    });
}

}  // namespace carom::render
