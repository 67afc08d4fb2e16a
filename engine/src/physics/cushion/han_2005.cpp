// Cushion model `han_2005`: Han, "Dynamics in carom and three cushion billiards", J. Mech. Sci. Tech. 19
// (2005), 976, with the misprints of equations 14c and 21a corrected. Frame: X into the cushion, Z up, Y = Z
// x X. s, c: sine and cosine of the nose's height angle. S: slip at the nose (S_x along the slope, S_y along
// the cushion); N: normal impulse; P: tangential impulse (per mass).
#include <algorithm>
#include <cmath>

#include "physics/cushion/nose.h"

namespace carom {
namespace detail {

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
    // Stick (2/7 of the slip) or slip (f N).
    const double k = slip > 0.0 ? std::min(2.0 / 7.0, p.f_c * N / slip) : 0.0;
    const double P_x = k * S_x, P_y = k * S_y;
    const double P_X = -P_x * s - N * c, P_Z = P_x * c - N * s;
    const double turn = 2.5 / R;
    const double dw_X = -turn * P_y * s, dw_Y = turn * (P_X * s - P_Z * c), dw_Z = turn * P_y * c;
    // Changes are added, so that nothing else is rounded: without friction, at ball height, the bits equal
    // those of the model smooth.
    v = Vec3(v.x() + (P_X * X.x() + P_y * Y.x()), v.y() + (P_X * X.y() + P_y * Y.y()), 0.0);
    w = Vec3(w.x() + (dw_X * X.x() + dw_Y * Y.x()), w.y() + (dw_X * X.y() + dw_Y * Y.y()), w.z() + dw_Z);
    return true;
}

}  // namespace detail

constinit const CushionModelInfo kHan2005 = {
    .name = "han_2005",
    .source = "Han, J. Mech. Sci. Tech. 19 (2005)",
    .resolve = detail::cushion_han_2005,
    .reads_friction = true,
    .reflects_when_level = true,
};

}  // namespace carom
