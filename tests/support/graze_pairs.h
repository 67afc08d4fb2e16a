// Seeded pairs of balls that pass each other at a given depth, to test detection. Needs engine/src.
#pragma once

#include "carom/engine/math.h"
#include "contact/detect.h"
#include "contact/roots.h"
#include "physics/motion.h"
#include "reference/random_impacts.h"

namespace carom::test {
using reference::Generator;

inline Vec2 turned(const Vec2& a, const Vec2& e) {
    return {a.x() * e.x() - a.y() * e.y(), a.x() * e.y() + a.y() * e.x()};
}

/// From the origin. kind: 0 at rest, 1 rolls, 2 slides.
inline Path random_path(Generator& rng, int kind, double speed) {
    const SinCos c = sin_cos(rng.uniform(0.0, 6.283185307179586)),
                 d = sin_cos(rng.uniform(0.0, 6.283185307179586));
    const Vec2 v = speed * Vec2(c.cos, c.sin);
    if (kind == 0) return {{0, 0}, {0, 0}, {0, 0}, kNever, true, false};
    if (kind == 1) return {{0, 0}, v, v * (-0.0981 / speed), speed / 0.0981, true, true};
    return {{0, 0}, v, 1.962 * Vec2(d.cos, d.sin), rng.uniform(0.05, 1.0) * speed / 1.962, false, true};
}

/// Places ball 2 so that at time t the two pass at right angles to their relative velocity, `depth` within
/// reach.
inline void set_to_graze(const Path& one, Path& two, double t, double depth, double reach, Generator& rng) {
    const Vec2 v = (two.v - one.v) + t * (two.a - one.a);
    const double speed = length(v);
    const Vec2 across = turned(v / speed, Vec2(0.0, rng.next() % 2 ? 1.0 : -1.0));
    const Vec2 travelled = t * ((two.v - one.v) + 0.5 * t * (two.a - one.a));
    two.r = one.r + (reach - depth) * across - travelled;
}

}  // namespace carom::test
