// Dual numbers: a value, and its derivatives by several inputs.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "carom/engine/ball_ball.h"
#include "carom/engine/vec.h"

namespace carom::tangent {

// The same functions for duals follow.
using carom::contact_distance, carom::cross, carom::cross3, carom::dot, carom::dot3, carom::length,
    carom::length3, carom::planar;

/// Inputs per replay: one vector register of 512 bits.
inline constexpr int kLanes = 8;
using Lanes = std::array<double, kLanes>;

struct Dual {
    double x = 0.0;
    Lanes d{};
    Dual() = default;
    Dual(double value) : x(value) {}  // NOLINT(google-explicit-constructor): a number is a constant
};

/// A function of a and b with these derivatives.
inline Dual chain(double x, const Dual& a, double by_a, const Dual& b, double by_b) {
    Dual r(x);
    for (int i = 0; i < kLanes; ++i) r.d[i] = by_a * a.d[i] + by_b * b.d[i];
    return r;
}
inline Dual chain(double x, const Dual& a, double by_a) {
    Dual r(x);
    for (int i = 0; i < kLanes; ++i) r.d[i] = by_a * a.d[i];
    return r;
}
inline bool operator<(const Dual& a, const Dual& b) {
    return a.x < b.x;
}
inline Dual operator+(const Dual& a, const Dual& b) {
    return chain(a.x + b.x, a, 1.0, b, 1.0);
}
inline Dual operator-(const Dual& a, const Dual& b) {
    return chain(a.x - b.x, a, 1.0, b, -1.0);
}
inline Dual operator-(const Dual& a) {
    return chain(-a.x, a, -1.0);
}
inline Dual operator*(const Dual& a, const Dual& b) {
    return chain(a.x * b.x, a, b.x, b, a.x);
}
inline Dual operator/(const Dual& a, const Dual& b) {
    return chain(a.x / b.x, a, 1.0 / b.x, b, -(a.x / b.x) / b.x);
}
/// The derivative of the root of 0 is set to 0: it belongs to a length that stays 0.
inline Dual sqrt(const Dual& a) {
    const double root = std::sqrt(a.x);
    return chain(root, a, root > 0.0 ? 0.5 / root : 0.0);
}

using Dual2 = std::array<Dual, 2>;
using Dual3 = std::array<Dual, 3>;

inline Dual dot(const Dual2& a, const Dual2& b) {
    return a[0] * b[0] + a[1] * b[1];
}
inline Dual cross(const Dual2& a, const Dual2& b) {
    return a[0] * b[1] - a[1] * b[0];
}
inline Dual length(const Dual2& a) {
    return sqrt(dot(a, a));
}
inline Dual dot3(const Dual3& a, const Dual3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Dual3 cross3(const Dual3& a, const Dual3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Dual length3(const Dual3& a) {
    return sqrt(dot3(a, a));
}
inline Dual2 planar(const Dual3& a) {
    return {a[0], a[1]};
}
template <std::size_t N>
std::array<Dual, N> operator-(const std::array<Dual, N>& a, const std::array<Dual, N>& b) {
    std::array<Dual, N> r;
    for (std::size_t i = 0; i < N; ++i) r[i] = a[i] - b[i];
    return r;
}

inline Dual contact_distance(const Dual& R1, const Dual& R2, bool discs) {
    const double x = carom::contact_distance(R1.x, R2.x, discs);
    return chain(x, R1, discs ? 1.0 : 0.5 * x / R1.x, R2, discs ? 1.0 : 0.5 * x / R2.x);
}

}  // namespace carom::tangent
