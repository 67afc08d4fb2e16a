// A frictionless gas in a box of reflecting cushions: many events, and every ball meets every other.
#pragma once

#include <cstdint>
#include <string>

#include "carom/engine/math.h"
#include "reference/random_impacts.h"
#include "support/hard_scenes.h"

namespace carom::test {
using reference::Generator;

/// n balls on a jittered square grid (n a square), moving at 1 m/s in random directions; balls cover a fifth
/// of the area.
inline Scene gas(int n, long events, std::uint64_t seed) {
    Scene scene = frictionless();
    scene.physics.clusters = ClusterModel::kSequential;
    scene.stop.events = events;
    int side = 1;
    while (side * side < n) ++side;
    const double cell = 4.0 * scene.balls.R;
    scene.table = box(cell * side, cell * side, 0.036576);
    Generator rng(seed);
    for (int i = 0; i < n; ++i) {
        const SinCos v = sin_cos_deg(rng.uniform(0.0, 360.0));
        const int column = i % side, row = i / side;
        const double y = cell * (row + rng.uniform(0.3, 0.7));
        const double x = cell * (column + rng.uniform(0.3, 0.7));
        add_ball(scene, std::to_string(i + 1), x, y, v.cos, v.sin, rolling_spin(v.cos, v.sin, scene.balls.R));
    }
    return scene;
}

}  // namespace carom::test
