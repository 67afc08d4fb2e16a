// Cushion model `smooth`: a reflection.
#include "physics/cushion/nose.h"

namespace carom {
namespace detail {

bool cushion_smooth(const CushionContact& p, const Vec2& normal, Vec3& v, Vec3&) {
    const double approach = approach_speed(normal, v);
    if (!(approach > 0.0)) return true;
    const double change = (1.0 + p.e_c) * approach;
    v = Vec3(v.x() + change * normal.x(), v.y() + change * normal.y(), 0.0);
    return true;
}

}  // namespace detail

constinit const CushionModelInfo kSmooth = {
    .name = "smooth",
    .source = "reflection",
    .resolve = detail::cushion_smooth,
    .reflects_when_level = true,
    .grip = nullptr,
};

}  // namespace carom
