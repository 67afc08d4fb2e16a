// The paper's best combination: rsqrt with Newton steps, roots independent of branches, two stages,
// precomputed constants.
#pragma once

#include "ladder/precomputed.h"
#include "ladder/roots.h"

namespace carom::kernel {
namespace {

struct CombinedStep {
    // As in PrecomputedStep, k.R and k.m are 1.
    template <int kSign>
    static void step(FrameState& s, const Constants& k) {
        const double c_x = s.v1x - s.v2x - (s.w1z + s.w2z), c_z = s.w1x + s.w2x;
        const double u1x = s.v1x + kSign * s.w1y, u1y = s.v1y - kSign * s.w1x;
        const double u2x = s.v2x + kSign * s.w2y, u2y = s.v2y - kSign * s.w2x;
        const bool second = c_z < 0.0;
        const double u_x = second ? u2x : u1x, u_y = second ? u2y : u1y;
        const double square = c_x * c_x + c_z * c_z, u = u_x * u_x + u_y * u_y, h = k.dP;
        const bool slips = square >= kSlipCutoff * kSlipCutoff, turns = slips && absolute(c_z) >= kSlipCutoff;
        const double friction = slips ? k.mu_b * h * NewtonRoot::inverse(square) : 0.0;
        const double J1 = friction * c_x, J2 = turns ? -friction * c_z : 0.0;
        const double cloth = turns && u > k.u_floor * k.u_floor
                                 ? (second ? k.mu_s2 * J2 : -k.mu_s1 * J2) * NewtonRoot::inverse(u)
                                 : 0.0;
        const double Qx = cloth * u_x, Qy = cloth * u_y;
        const double Q1x = second ? 0.0 : Qx, Q1y = second ? 0.0 : Qy, Q2x = second ? Qx : 0.0,
                     Q2y = second ? Qy : 0.0;
        s.v1x -= J1 + Q1x;
        s.v1y -= h + Q1y;
        s.v2x += J1 - Q2x;
        s.v2y += h - Q2y;
        s.w1x += 2.5 * (J2 - Q1y);
        s.w1y += 2.5 * Q1x;
        s.w1z += 2.5 * J1;
        s.w2x += 2.5 * (J2 - Q2y);
        s.w2y += 2.5 * Q2x;
        s.w2z += 2.5 * J1;
    }
};

using Combined = OfUnitBalls<InTwoStages<CombinedStep>>;

}  // namespace
}  // namespace carom::kernel
