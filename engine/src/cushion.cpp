#include "carom/engine/cushion.h"

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

// Han, "Dynamics in carom and three cushion billiards", J. Mech. Sci. Tech. 19 (2005), 976, with the misprints of equations
// 14c and 21a mended. Frame: X into the cushion, Z up, Y = Z x X. s, c: sine and cosine of the nose's height angle.
// S: slip at the nose (S_x along the slope, S_y along the cushion); N: normal impulse; P: tangential impulse (per mass).
void han_2005(const CushionContact& p, const Vec2& X, Vec3& v, Vec3& w) {
    const Vec2 Y(-X.y(), X.x());
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
    const double new_v_X = v_X + P_X, new_v_Y = v_Y + P_y;
    const double new_w_X = w_X - turn * P_y * s, new_w_Y = w_Y + turn * (P_X * s - P_Z * c), new_w_Z = w_Z + turn * P_y * c;
    v = Vec3(new_v_X * X.x() + new_v_Y * Y.x(), new_v_X * X.y() + new_v_Y * Y.y(), 0.0);
    w = Vec3(new_w_X * X.x() + new_w_Y * Y.x(), new_w_X * X.y() + new_w_Y * Y.y(), new_w_Z);
}

}  // namespace

void resolve_cushion(CushionModel model, const CushionContact& contact, const Vec2& normal, Vec3& v, Vec3& w) {
    const double approach = -(v.x() * normal.x() + v.y() * normal.y());
    if (!(approach > 0.0)) return;
    switch (model) {
        case CushionModel::kSmooth: {
            const double change = (1.0 + contact.e_c) * approach;
            v = Vec3(v.x() + change * normal.x(), v.y() + change * normal.y(), 0.0);
            return;
        }
        case CushionModel::kHan2005: han_2005(contact, -normal, v, w); return;
    }
}

}  // namespace carom
