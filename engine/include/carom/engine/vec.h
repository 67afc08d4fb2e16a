// Vectors of the engine. Sums over x and y use Vec2, so that swapping the axes does not change the rounding.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace carom {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

/// A rectangle on the table, (low x, low y, high x, high y) [m].
using Rectangle = Eigen::Matrix<double, 4, 1, Eigen::DontAlign>;
inline bool is_inside(const Rectangle& r, const Vec2& p) {
    return p.x() >= r[0] && p.y() >= r[1] && p.x() <= r[2] && p.y() <= r[3];
}

inline Vec2 planar(const Vec3& a) {
    return {a.x(), a.y()};
}

inline double dot(const Vec2& a, const Vec2& b) {
    return a.dot(b);
}

/// Length of a planar vector; no overflow, no underflow, no libm.
inline double length(const Vec2& a) {
    const double largest = std::max(std::abs(a.x()), std::abs(a.y()));
    if (largest == 0.0) return 0.0;
    // In this range squares are normal numbers; outside it, scale by a power of two (exact).
    if (largest > 0x1p-500 && largest < 0x1p500) return std::sqrt(a.x() * a.x() + a.y() * a.y());
    const double scale = largest < 1.0 ? 0x1p600 : 0x1p-600;
    const double x = a.x() * scale, y = a.y() * scale;
    return std::sqrt(x * x + y * y) / scale;
}

/// Sums over three axes add x and y first, so that swapping these does not change the rounding.
inline double dot3(const Vec3& a, const Vec3& b) {
    return (a.x() * b.x() + a.y() * b.y()) + a.z() * b.z();
}
inline Vec3 cross3(const Vec3& a, const Vec3& b) {
    return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}
inline double length3(const Vec3& a) {
    return length(Vec2(length(planar(a)), a.z()));
}

/// z-component of a x b.
inline double cross(const Vec2& a, const Vec2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// Distance of p from the segment between two distinct points. The cross product makes it exact to rounding
/// for p close to the line.
inline double distance_to_segment(const Vec2& p, const Vec2& from, const Vec2& to) {
    const Vec2 along = to - from;
    const double s = dot(p - from, along);
    if (s <= 0.0) return length(p - from);
    if (s >= dot(along, along)) return length(p - to);
    return std::abs(cross(p - from, along)) / length(along);
}

}  // namespace carom
