#include "contact/pocket_edge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace carom {

int pocket_under(const Geometry& geometry, const Vec2& here) {
    int under = -1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < geometry.pockets.size(); ++i) {
        const Pocket& pocket = geometry.pockets[i];
        const double beyond = length(here - pocket.center) - pocket.radius;
        if (!(beyond < least)) continue;
        least = beyond;
        under = static_cast<int>(i);
    }
    return under;
}

double time_to_edge(const Vec2& r, const Vec2& v, const Vec2& center, double radius) {
    const Vec2 out = r - center;
    const double speed2 = dot(v, v), along = dot(out, v);
    if (!(speed2 > 0.0)) return kNever;
    // The later root of |out + v t| = radius. It is real inside the circle; on the circle, rounding may make
    // it complex.
    const double inside = (radius - length(out)) * (radius + length(out));
    const double root = std::sqrt(std::max(0.0, along * along + speed2 * inside));
    return std::max(0.0, along > 0.0 ? inside / (along + root) : (root - along) / speed2);
}

bool is_bed(const Table& table, const Pocket& pocket, const Vec2& here, double R) {
    if (table.bed) return is_inside(*table.bed, here);
    if (!(table.width > 0.0 && table.length > 0.0)) return true;  // it has no end
    const Vec2 c = pocket.center, low = table.corner, high = low + Vec2(table.width, table.length);
    if (is_inside(Rectangle(low.x(), low.y(), high.x(), high.y()), c)) return true;
    const Rectangle between_jaws(low.x() - R, low.y() - R, high.x() + R, high.y() + R);
    return is_inside(between_jaws, here) && dot(here - c, Vec2(0.5 * (low + high) - c)) > 0.0;
}

std::optional<double> climbs(double v_n, double sunk, double R, double gravity) {
    if (!(sunk < 1.0) || !(v_n > 0.0)) return std::nullopt;
    const double kept = (1.0 - sunk) * v_n, left = kept * kept - 2.0 * gravity * R * sunk;
    return left > 0.0 ? std::optional(std::sqrt(left)) : std::nullopt;
}

}  // namespace carom
