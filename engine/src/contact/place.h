// An order of positions on the table, for sums that must be the same to the last bit in a mirror image.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "carom/engine/vec.h"

namespace carom {

/// An order that reflections in the axes and quarter turns preserve, except for the order of mirror images
/// among themselves.
inline bool before_place(const Vec2& p, const Vec2& q) {
    const auto key = [](const Vec2& a) {
        const double x = std::abs(a.x()), y = std::abs(a.y());
        return std::array<double, 4>{std::max(x, y), std::min(x, y), a.y(), a.x()};
    };
    return key(p) < key(q);
}

}  // namespace carom
