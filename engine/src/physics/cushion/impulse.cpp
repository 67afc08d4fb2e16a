// Cushion model `impulse`: one frictional impulse along the inclined normal, as for two rough spheres:
// Coulomb's f J_n, or 2/7 of the slip if that suffices to end it. Equations: docs/reference/physics.md,
// "Cushion impact".
#include "physics/cushion/nose.h"

namespace carom {
namespace detail {

bool cushion_impulse(const CushionContact& p, const Vec2& normal, Vec3& v, Vec3& w) {
    if (!(approach_speed(normal, v) > 0.0)) return true;
    const NoseContact c = nose_contact(p, normal, v, w);
    const double J_n = -(1.0 + p.e_c) * c.u_n;
    const double J_t = coulomb_grip(p.e_c, p.f_c, -c.u_n, c.speed_t);
    apply_at_nose(p, c, J_n, J_t, v, w);
    return true;
}

}  // namespace detail

extern constinit const CushionModelInfo kImpulse = {
    .name = "impulse",
    .source = "one Coulomb impulse along the inclined normal",
    .resolve = detail::cushion_impulse,
    .reads_friction = true,
    .reflects_when_level = true,
};

}  // namespace carom
