#include "physics/cue.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "carom/engine/geometry.h"
#include "carom/engine/math.h"
#include "carom/engine/strike.h"

namespace carom {

namespace effects {

// Squirt turns the velocity by -atan2(S, C), computed as a ratio. A cue without end mass produces no squirt.
[[gnu::noinline]] SinCos squirt(const Cue& cue, const BallSize& ball) {
    const double a = cue.side;
    if (a == 0.0 || cue.end_mass == 0.0) return {0.0, 1.0};
    const double S = 2.5 * a * std::sqrt(1.0 - a * a);
    const double C = 1.0 + ball.m / cue.end_mass + 2.5 * (1.0 - a * a);
    const double h = std::sqrt(S * S + C * C);
    return {-S / h, C / h};
}

// The same in space: the velocity turns away from the offset by that angle, in the plane of the cue and the
// contact point.
[[gnu::noinline]] Vec3 spatial_squirt(const Cue& cue, const BallSize& ball, const Vec3& along,
                                      const Vec3& left, const Vec3& up) {
    const double a = cue.side, b = cue.height, r = std::sqrt(a * a + b * b);
    if (r == 0.0 || cue.end_mass == 0.0) return along;
    const double S = 2.5 * r * std::sqrt(1.0 - r * r);
    const double C = 1.0 + ball.m / cue.end_mass + 2.5 * (1.0 - r * r);
    const double h = std::sqrt(S * S + C * C);
    return C / h * along - S / h * (a / r * left + b / r * up);
}

}  // namespace effects

namespace {

struct Axes {
    Vec3 along, left, up;
};
Axes axes_of(const SinCos& aim, const SinCos& elevation) {
    return {{aim.cos * elevation.cos, aim.sin * elevation.cos, -elevation.sin},
            {-aim.sin, aim.cos, 0.0},
            {aim.cos * elevation.sin, aim.sin * elevation.sin, elevation.cos}};
}

/// [m/s] Speed of the ball along the cue.
double struck_speed(const Cue& cue, const BallSize& ball) {
    const double a = cue.side, b = cue.height;
    return (1.0 + cue.restitution) * cue.speed / (1.0 + ball.m / cue.mass + 2.5 * (a * a + b * b));
}

}  // namespace

StruckBall strike(const Cue& cue, const BallSize& ball, bool squirt, Vertical vertical) {
    const double a = cue.side, b = cue.height;
    const auto [sin_aim, cos_aim] = sin_cos_deg(cue.aim_deg);
    const auto [sin_up, cos_up] = sin_cos_deg(cue.elevation_deg);
    const double v = struck_speed(cue, ball);
    // w = (5 v / 2 R) (b l - a sin(th) t - a cos(th) z), l = left of the aim t.
    const double turn = 2.5 * v / ball.R;
    const Vec3 w(turn * (-b * sin_aim - a * sin_up * cos_aim), turn * (b * cos_aim - a * sin_up * sin_aim),
                 -turn * a * cos_up);
    if (vertical == Vertical::kKeep && cue.elevation_deg > 0.0) {
        const Axes axes = axes_of({sin_aim, cos_aim}, {sin_up, cos_up});
        const Vec3 direction =
            squirt ? effects::spatial_squirt(cue, ball, axes.along, axes.left, axes.up) : axes.along;
        return {v * direction, w, 0.0};
    }
    const auto [sin_squirt, cos_squirt] = squirt ? effects::squirt(cue, ball) : SinCos{0.0, 1.0};
    const double speed = v * cos_up;
    return {Vec3(speed * (cos_aim * cos_squirt - sin_aim * sin_squirt),
                 speed * (sin_aim * cos_squirt + cos_aim * sin_squirt), 0.0),
            w, v * sin_up};
}

bool meets_tip_again(const Cue& cue, const BallSize& ball, const Vec3& v, const Vec3& w) {
    const double a = cue.side, b = cue.height;
    const Axes axes = axes_of(sin_cos_deg(cue.aim_deg), sin_cos_deg(cue.elevation_deg));
    const Vec3 tip = ball.R * (a * axes.left + b * axes.up - std::sqrt(1.0 - a * a - b * b) * axes.along);
    // The cue keeps its remaining momentum.
    const double cue_speed = cue.speed - ball.m / cue.mass * struck_speed(cue, ball);
    return !(dot3(v + cross3(w, tip), axes.along) > cue_speed);
}

// The space that the cue occupies during the stroke: whether rails and other balls leave room for it.

namespace {

// [m] A usual cue: 58 inches long, 13 mm thick at the tip and 29 mm at the butt.
constexpr double kCueLength = 1.473, kTipRadius = 0.0065, kButtRadius = 0.0145;
// [degrees] A level cue in a scene represents one raised as little as the rails require, by some 2 to 4
// degrees.
constexpr double kLevel = 5.0;
// [degrees] Elevations to try.
constexpr int kElevations = 890;
constexpr double kElevationStep = 0.1;

/// A cue as a cone: from the tip backwards.
struct Cone {
    Vec3 tip, back;
    double radius_at(double s) const { return kTipRadius + (kButtRadius - kTipRadius) * (s / kCueLength); }
    Vec3 at(double s) const { return tip + s * back; }
};

Cone cone_of(const Cue& cue, double elevation_deg, const Vec3& ball, double R) {
    const SinCos aim = sin_cos_deg(cue.aim_deg), up = sin_cos_deg(elevation_deg);
    const Vec3 along(aim.cos * up.cos, aim.sin * up.cos, -up.sin), left(-aim.sin, aim.cos, 0.0),
        above(aim.cos * up.sin, aim.sin * up.sin, up.cos);
    const double depth = std::sqrt(1.0 - cue.side * cue.side - cue.height * cue.height);
    return {ball + R * (cue.side * left + cue.height * above - depth * along), -along};
}

/// Whether the cone is clear of an edge that it crosses at s, as seen from above. `turn` is the sine of the
/// angle between the two there.
bool clears_edge(const Cone& cone, double s, double height, double turn) {
    // If the ball touches the nose, the tip is above it, within rounding.
    if (!(s > -1e-9 && s <= kCueLength)) return true;
    const double level = length(planar(cone.back)), over = cone.at(s).z() - height;
    // Between two lines in space.
    const double apart = over * level * turn / length(Vec2(level * turn, cone.back.z()));
    return apart >= cone.radius_at(s);
}

bool clears(const Cone& cone, const Cushion& cushion) {
    const Vec2 from = cushion.from - planar(cone.tip), line = cushion.to - cushion.from,
               back = planar(cone.back);
    const double across = cross(back, line);
    if (across == 0.0) return true;
    const double s = cross(from, line) / across, share = cross(from, back) / across;
    if (!(share >= 0.0 && share <= 1.0)) return true;
    return clears_edge(cone, s, cushion.height, std::abs(across) / (length(back) * length(line)));
}

bool clears(const Cone& cone, const Jaw& jaw) {
    const Vec2 from = planar(cone.tip) - jaw.center, back = planar(cone.back);
    const double a = dot(back, back), b = dot(from, back),
                 D = b * b - a * (dot(from, from) - jaw.radius * jaw.radius);
    if (!(a > 0.0) || !(D > 0.0)) return true;
    // A wall around the ball is crossed outwards.
    const double s = (-b + (jaw.around() ? std::sqrt(D) : -std::sqrt(D))) / a;
    const Vec2 out = from + s * back;
    if (!span_of(jaw).holds(out)) return true;
    return clears_edge(cone, s, jaw.height, std::abs(dot(out, back)) / (length(out) * length(back)));
}

bool clears(const Cone& cone, const Vec3& ball, double R) {
    const double s = std::clamp(dot3(ball - cone.tip, cone.back), 0.0, kCueLength);
    return length3(cone.at(s) - ball) >= R + cone.radius_at(s);
}

/// The obstacle that the cue would intersect, or "".
std::string met(const Scene& scene, const Cue& cue, double elevation_deg) {
    const BallStart* struck = nullptr;
    for (const BallStart& ball : scene.ball)
        if (ball.id == cue.ball) struck = &ball;
    if (struck == nullptr) return "";
    const Cone cone = cone_of(cue, elevation_deg, struck->position, scene.size_of(*struck).R);
    for (const Cushion& cushion : scene.table.cushions)
        if (!clears(cone, cushion)) return "cushion " + cushion.id;
    for (const Jaw& jaw : scene.table.jaws)
        if (!clears(cone, jaw)) return (jaw.is_arc() ? "arc " : "jaw ") + jaw.id;
    for (const BallStart& ball : scene.ball)
        if (&ball != struck && !clears(cone, ball.position, scene.size_of(ball).R)) return "ball " + ball.id;
    return "";
}

}  // namespace

CueRoom room_for(const Scene& scene, const Cue& cue) {
    CueRoom room{met(scene, cue, cue.elevation_deg), cue.elevation_deg};
    if (room.in.empty()) return room;
    std::string last = room.in;
    for (int k = 0; k <= kElevations; ++k) {
        const double elevation = kElevationStep * k;
        if (elevation <= cue.elevation_deg) continue;
        if (const std::string in = met(scene, cue, elevation); !in.empty()) {
            last = in;
            continue;
        }
        room.clears_deg = elevation;
        // Name the part that forces this elevation, not the one that forces the smallest.
        room.in = last;
        return room;
    }
    room.clears_deg.reset();
    return room;
}

std::string room_note(const Scene& scene) {
    if (!scene.cue || !(scene.cue->speed > 0.0)) return "";
    const CueRoom room = room_for(scene, *scene.cue);
    if (room.in.empty() || (room.clears_deg && *room.clears_deg <= kLevel)) return "";
    return fmt::format(
        "the cue would reach into {} at an elevation of {} degrees; {}", room.in, scene.cue->elevation_deg,
        room.clears_deg ? fmt::format("set cue.elevation_deg = {:.1f}, or \"auto\"", *room.clears_deg)
                        : "no elevation clears it");
}

}  // namespace carom
