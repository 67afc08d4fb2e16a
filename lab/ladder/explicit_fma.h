// Section 3.4: fused multiply-add wherever the step has a product and a sum. Requires FMA.
#pragma once

#include "ladder/precomputed.h"

namespace carom::kernel {
namespace {

inline double fma3(double a, double b, double c) {
    return __builtin_fma(a, b, c);
}

struct ExplicitFmaStep {
    template <int kSign>
    static void step(FrameState& s, const Constants& k) {
        const double c_x = fma3(-k.R, s.w1z + s.w2z, s.v1x - s.v2x);
        const double c_z = k.R * (s.w1x + s.w2x);
        const double c = square_root(fma3(c_x, c_x, c_z * c_z));
        const double h = k.dP / k.m;
        double Q1x = 0.0, Q1y = 0.0, Q2x = 0.0, Q2y = 0.0, J1 = 0.0, J2 = 0.0;
        if (!(c < kSlipCutoff)) {
            const double friction = -k.mu_b * h / c;
            J1 = friction * c_x;
            if (!(absolute(c_z) < kSlipCutoff)) {
                J2 = friction * c_z;
                if (J2 > 0.0) {
                    const double u_x = fma3(kSign * k.R, s.w2y, s.v2x),
                                 u_y = fma3(-kSign * k.R, s.w2x, s.v2y);
                    const double u = square_root(fma3(u_x, u_x, u_y * u_y));
                    const double cloth = u > k.u_floor ? -k.mu_s2 * J2 / u : 0.0;
                    Q2x = cloth * u_x;
                    Q2y = cloth * u_y;
                } else {
                    const double u_x = fma3(kSign * k.R, s.w1y, s.v1x),
                                 u_y = fma3(-kSign * k.R, s.w1x, s.v1y);
                    const double u = square_root(fma3(u_x, u_x, u_y * u_y));
                    const double cloth = u > k.u_floor ? k.mu_s1 * J2 / u : 0.0;
                    Q1x = cloth * u_x;
                    Q1y = cloth * u_y;
                }
            }
        }
        const double spin = k.C * k.m;
        s.v1x += J1 + Q1x;
        s.v1y += Q1y - h;
        s.v2x += Q2x - J1;
        s.v2y += h + Q2y;
        s.w1x = fma3(spin, J2 + Q1y, s.w1x);
        s.w1y = fma3(-spin, Q1x, s.w1y);
        s.w1z = fma3(-spin, J1, s.w1z);
        s.w2x = fma3(spin, J2 + Q2y, s.w2x);
        s.w2y = fma3(-spin, Q2x, s.w2y);
        s.w2z = fma3(-spin, J1, s.w2z);
    }
};

using ExplicitFma = WithStep<ExplicitFmaStep>;

}  // namespace
}  // namespace carom::kernel
