// How far a direction stays smooth along an assumed straight path, which limits the width of a block of the
// summed integration (summed.h).
#pragma once

#include <cstdint>

#include "numbers.h"
#include "simd.h"

namespace carom::kernel {
namespace {

using Eight = Pack<8>;

// Distance of the poles that a block keeps, relative to the estimate for the tolerance.
constexpr double kPoleMargin = 0.35;

// Smoothness of the direction of a vector along a block of K steps, from (a, b) with (da, db) per step. The
// direction has poles where the length vanishes, at complex t. On a straight path, they are on the ellipse
// around the block whose half axes have the sum rho, and the modes fall as rho^-n. `amplitude` is the largest
// effect of the direction on a result, in units of the tolerance.
struct Path {
    double a, b, da, db, needed;  // needed: (rho + 1/rho) / 2
};

// Accurate to 10%, which suffices here: the bits of a double, divided by 8, are close to those of the root.
inline double eighth_root(double x) {
    // Not long, which has 4 bytes on wasm32, 32-bit ARM and 64-bit Windows.
    std::int64_t bits;
    __builtin_memcpy(&bits, &x, sizeof x);
    bits = bits / 8 + std::int64_t{0x3ff0000000000000} / 8 * 7;
    __builtin_memcpy(&x, &bits, sizeof x);
    return x;
}

inline Path path(double a, double b, double da, double db, double amplitude) {
    // On a straight path through zero the direction reverses between two nodes, without an effect on any
    // mode. So no path is treated as quite straight.
    const double sine = largest(
        absolute(a * db - b * da) / (square_root((a * a + b * b) * (da * da + db * db)) + 1e-300), 1e-16);
    const double rho = 1.0 + kPoleMargin * eighth_root(amplitude * sine);
    return {a, b, da, db, 0.5 * (rho + 1.0 / rho)};
}

// The slack for every block size at once: >= 0 if the direction is smooth enough.
inline Eight slack(const Path& p, Eight K) {
    const Eight a = p.a + K * p.da, b = p.b + K * p.db;
    return square_root(p.a * p.a + p.b * p.b) + square_root(a * a + b * b) -
           K * (p.needed * square_root(p.da * p.da + p.db * p.db));
}

}  // namespace
}  // namespace carom::kernel
