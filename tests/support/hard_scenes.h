// Shared by the hard cases. CAROM_RESIDUALS=1 in the environment prints each case's measurements.
#pragma once

#include <cstdio>
#include <cstdlib>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"

#include "support/engine_cases.h"

namespace carom::test {

inline void report(const char* what, double residual) {
    if (std::getenv("CAROM_RESIDUALS") != nullptr) std::printf("residual %s: %.3g\n", what, residual);
}

/// A table without a size whose foot spot is `apex`, for racks at a given place.
inline Table spot_at(const Vec2& apex) {
    Table table;
    table.corner = apex;
    return table;
}

/// No friction anywhere; elastic balls and cushions.
inline Scene frictionless() {
    Scene scene = empty_scene();
    BallParams& b = scene.balls;
    b.mu_s = b.mu_r = b.mu_sp = b.mu_b = b.f_c = 0.0;
    b.e_b = b.e_c = 1.0;
    scene.physics.ball_ball = ball_ball_model("elastic");
    scene.physics.cushion = &kSmooth;
    return scene;
}

}  // namespace carom::test
