// Seeded random impacts between equal balls, for the tests, the benchmark and the accuracy report.
//
// A mixture of six kinds: ball 1 slides into a resting ball, it rolls into a resting ball, both balls roll,
// both have strong spin (up to 200 rad/s), ball 1 only glances a resting ball, both slide. The ranges are
// 0.01..0.12 for mu_b, 0.1..0.4 for mu_s of each ball, 0.8..1 for e_b, and about 0.05..8 m/s for the approach
// speed.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "carom/kernel/impact.h"
#include "carom/kernel/splitmix64.h"

namespace carom::reference {

inline constexpr double kDegree = std::numbers::pi / 180.0;  // in radians

using Generator = SplitMix64;

struct Impact {
    kernel::Ball ball1, ball2;
    kernel::ImpactParams params;
};

inline Impact random_impact(Generator& rng) {
    Impact impact{};
    kernel::ImpactParams& p = impact.params;
    p.R = 0.028575;
    p.m = 0.170097;
    p.mu_s1 = rng.uniform(0.1, 0.4);
    p.mu_s2 = rng.uniform(0.1, 0.4);
    p.mu_b = rng.uniform(0.01, 0.12);
    p.e_b = rng.uniform(0.8, 1.0);
    enum { kAtRest, kRolling, kBothRolling, kStrongSpin, kGlancing, kBothSliding, kKinds };
    const int kind = static_cast<int>(rng.next() % kKinds);
    const double angle = rng.uniform(0.0, 6.283185307179586);
    const double nx = std::cos(angle), ny = std::sin(angle);  // from ball 1 to ball 2
    kernel::Ball &b1 = impact.ball1, &b2 = impact.ball2;
    b1.r[0] = rng.uniform(0.1, 0.9);
    b1.r[1] = rng.uniform(0.1, 1.8);
    b1.r[2] = b2.r[2] = p.R;
    b2.r[0] = b1.r[0] + 2.0 * p.R * nx;
    b2.r[1] = b1.r[1] + 2.0 * p.R * ny;
    const double speed = 0.05 * std::pow(160.0, rng.uniform());
    // The cut angle, from the line of centres to the direction of ball 1.
    // In a glancing impact the approach speed is 1e-3..0.1 of the speed.
    const double cut =
        kind == kGlancing ? std::acos(std::pow(10.0, rng.uniform(-3.0, -1.0))) : rng.uniform(-1.4, 1.4);
    const double c = std::cos(cut), s = std::sin(cut);
    b1.v[0] = speed * (c * nx - s * ny);
    b1.v[1] = speed * (c * ny + s * nx);
    const auto spin = [&](kernel::Ball& b, double most) {
        for (double& w : b.w) w = rng.uniform(-most, most);
    };
    const auto roll = [&](kernel::Ball& b) {
        b.w[0] = -b.v[1] / p.R;
        b.w[1] = b.v[0] / p.R;
        b.w[2] = rng.uniform(-30.0, 30.0);
    };
    if (kind == kRolling || kind == kBothRolling)
        roll(b1);
    else
        spin(b1, kind == kStrongSpin ? 200.0 : 60.0);
    if (kind == kStrongSpin || kind == kBothSliding) spin(b2, kind == kStrongSpin ? 200.0 : 60.0);
    if (kind == kBothRolling || kind == kBothSliding) {
        b2.v[0] = rng.uniform(-0.5, 0.5) * speed;
        b2.v[1] = rng.uniform(-0.5, 0.5) * speed;
    }
    if (kind == kBothRolling) roll(b2);
    const double approach = (b1.v[0] - b2.v[0]) * nx + (b1.v[1] - b2.v[1]) * ny;
    if (approach < 0.0) {  // turn the velocities, so that the balls approach
        for (int k = 0; k < 2; ++k) {
            b1.v[k] = -b1.v[k];
            b2.v[k] = -b2.v[k];
        }
        if (kind == kRolling || kind == kBothRolling) {
            for (int k = 0; k < 2; ++k) {
                b1.w[k] = -b1.w[k];
                b2.w[k] = -b2.w[k];
            }
        }
    }
    return impact;
}

inline std::vector<Impact> random_impacts(std::uint64_t seed, int count) {
    Generator rng(seed);
    std::vector<Impact> impacts;
    impacts.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) impacts.push_back(random_impact(rng));
    return impacts;
}

}  // namespace carom::reference
