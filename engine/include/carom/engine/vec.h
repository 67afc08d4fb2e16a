// Vectors of the engine. Planar sums (x, y) are taken as Vec2 so that swapping the axes swaps nothing but
// names.
#pragma once

#include <Eigen/Core>

namespace carom {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

/// z-component of a x b.
inline double cross(const Vec2& a, const Vec2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

}  // namespace carom
