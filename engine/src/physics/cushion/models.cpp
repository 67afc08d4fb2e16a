#include "carom/engine/cushion.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "physics/cushion/models.h"

namespace carom {
namespace detail {

bool cushion_smooth(const CushionContact& p, const Vec2& normal, Vec3& v, Vec3&) {
    const double approach = approach_speed(normal, v);
    if (!(approach > 0.0)) return true;
    const double change = (1.0 + p.e_c) * approach;
    v = Vec3(v.x() + change * normal.x(), v.y() + change * normal.y(), 0.0);
    return true;
}

// Han, "Dynamics in carom and three cushion billiards", J. Mech. Sci. Tech. 19 (2005), 976, with the
// misprints of equations 14c and 21a mended. Frame: X into the cushion, Z up, Y = Z x X. s, c: sine and
// cosine of the nose's height angle. S: slip at the nose (S_x along the slope, S_y along the cushion); N:
// normal impulse; P: tangential impulse (per mass).
bool cushion_han_2005(const CushionContact& p, const Vec2& normal, Vec3& v, Vec3& w) {
    if (!(approach_speed(normal, v) > 0.0)) return true;
    const Vec2 X = -normal, Y(-X.y(), X.x());
    const double R = p.R;
    const double s = (p.height - R) / R, c = std::sqrt((1.0 - s) * (1.0 + s));
    const double v_X = v.x() * X.x() + v.y() * X.y(), v_Y = v.x() * Y.x() + v.y() * Y.y();
    const double w_X = w.x() * X.x() + w.y() * X.y(), w_Y = w.x() * Y.x() + w.y() * Y.y(), w_Z = w.z();
    const double S_x = v_X * s + R * w_Y;
    const double S_y = -v_Y - R * w_Z * c + R * w_X * s;
    const double slip = std::sqrt(S_x * S_x + S_y * S_y);
    const double N = (1.0 + p.e_c) * v_X * c;
    // Sticks (2/7 of the slip) or slides (f N).
    const double k = slip > 0.0 ? std::min(2.0 / 7.0, p.f_c * N / slip) : 0.0;
    const double P_x = k * S_x, P_y = k * S_y;
    const double P_X = -P_x * s - N * c, P_Z = P_x * c - N * s;
    const double turn = 2.5 / R;
    const double dw_X = -turn * P_y * s, dw_Y = turn * (P_X * s - P_Z * c), dw_Z = turn * P_y * c;
    // Changes are added, so that nothing else is rounded: without friction, at ball height, these are the
    // bits of the model smooth.
    v = Vec3(v.x() + (P_X * X.x() + P_y * Y.x()), v.y() + (P_X * X.y() + P_y * Y.y()), 0.0);
    w = Vec3(w.x() + (dw_X * X.x() + dw_Y * Y.x()), w.y() + (dw_X * X.y() + dw_Y * Y.y()), w.z() + dw_Z);
    return true;
}

// One frictional impulse along the inclined normal, as for two rough spheres: Coulomb's f J_n, or what ends
// the slip (2/7 of it). Equations: docs/physics.md, "Cushion impact", impulse.
bool cushion_impulse(const CushionContact& p, const Vec2& normal, Vec3& v, Vec3& w) {
    if (!(approach_speed(normal, v) > 0.0)) return true;
    const NoseContact c = nose_contact(p, normal, v, w);
    const double J_n = -(1.0 + p.e_c) * c.u_n;
    const double J_t = std::min(p.f_c * J_n, 2.0 / 7.0 * c.speed_t);
    apply_at_nose(p, c, J_n, J_t, v, w);
    return true;
}

}  // namespace detail

std::span<const CushionModelInfo> cushion_models() {
    static constexpr CushionModelInfo kModels[] = {
        {.model = CushionModel::kHan2005,
         .name = "han_2005",
         .resolve = detail::cushion_han_2005,
         .reads_spin = true,
         .reads_friction = true,
         .reads_height = true,
         .source = "Han, J. Mech. Sci. Tech. 19 (2005)"},
        {.model = CushionModel::kMathavan2010,
         .name = "mathavan_2010",
         .resolve = detail::cushion_mathavan_2010,
         .reads_spin = true,
         .reads_friction = true,
         .reads_cloth = true,
         .reads_height = true,
         .source = "Mathavan, Jackson, Parkin, Proc. IMechE C 224 (2010)"},
        {.model = CushionModel::kStronge,
         .name = "stronge",
         .resolve = detail::cushion_stronge,
         .reads_spin = true,
         .reads_friction = true,
         .reads_height = true,
         .source = "Stronge, Impact Mechanics, compliant contact"},
        {.model = CushionModel::kImpulse,
         .name = "impulse",
         .resolve = detail::cushion_impulse,
         .reads_spin = true,
         .reads_friction = true,
         .reads_height = true,
         .source = "one Coulomb impulse along the inclined normal"},
        {.model = CushionModel::kSmooth,
         .name = "smooth",
         .resolve = detail::cushion_smooth,
         .source = "reflection"},
    };
    return kModels;
}

const CushionModelInfo& cushion_model(CushionModel model) {
    for (const CushionModelInfo& info : cushion_models())
        if (info.model == model) return info;
    return cushion_models().back();
}

bool resolve_cushion(CushionModel model, const CushionContact& contact, const Vec2& normal, Vec3& v,
                     Vec3& w) {
    return cushion_model(model).resolve(contact, normal, v, w);
}

}  // namespace carom
