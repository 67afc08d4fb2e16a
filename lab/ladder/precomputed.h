// Section 3.4: precomputation. Spins are carried as R w and impulses per unit mass, and every product of
// constants is computed once.
#pragma once

#include "ladder/step_loops.h"

namespace carom::kernel {
namespace {

// A state in which the step needs no factor R, m or C: w becomes R w [m/s].
inline void spins_to_speeds(FrameState& s, double R) {
    double* const spins[6] = {&s.w1x, &s.w1y, &s.w1z, &s.w2x, &s.w2y, &s.w2z};
    for (double* w : spins) *w *= R;
}

inline void speeds_to_spins(FrameState& s, double R) {
    double* const spins[6] = {&s.w1x, &s.w1y, &s.w1z, &s.w2x, &s.w2y, &s.w2z};
    for (double* w : spins) *w /= R;
}

struct PrecomputedStep {
    // Here k.R and k.m are 1 and k.C is 5/2.
    template <int kSign>
    static void step(FrameState& s, const Constants& k) {
        const double c_x = s.v1x - s.v2x - (s.w1z + s.w2z);
        const double c_z = s.w1x + s.w2x;
        const double c = square_root(c_x * c_x + c_z * c_z);
        const double h = k.dP, v1y = s.v1y, v2y = s.v2y;
        s.v1y -= h;
        s.v2y += h;
        if (c < kSlipCutoff) return;
        const double friction = k.mu_b * h / c, J1 = friction * c_x;
        if (absolute(c_z) < kSlipCutoff) {
            s.v1x -= J1;
            s.v2x += J1;
        } else if (c_z < 0.0) {
            const double J2 = -friction * c_z;
            const double u_x = s.v2x + kSign * s.w2y, u_y = v2y - kSign * s.w2x;
            const double u = square_root(u_x * u_x + u_y * u_y);
            const double cloth = u > k.u_floor ? k.mu_s2 * J2 / u : 0.0, Qx = cloth * u_x, Qy = cloth * u_y;
            s.v1x -= J1;
            s.v2x += J1 - Qx;
            s.v2y -= Qy;
            s.w1x += 2.5 * J2;
            s.w2x += 2.5 * (J2 - Qy);
            s.w2y += 2.5 * Qx;
        } else {
            const double J2 = -friction * c_z;
            const double u_x = s.v1x + kSign * s.w1y, u_y = v1y - kSign * s.w1x;
            const double u = square_root(u_x * u_x + u_y * u_y);
            const double cloth = u > k.u_floor ? -k.mu_s1 * J2 / u : 0.0, Qx = cloth * u_x, Qy = cloth * u_y;
            s.v1x -= J1 + Qx;
            s.v2x += J1;
            s.v1y -= Qy;
            s.w1x += 2.5 * (J2 - Qy);
            s.w2x += 2.5 * J2;
            s.w1y += 2.5 * Qx;
        }
        s.w1z += 2.5 * J1;
        s.w2z += 2.5 * J1;
    }
};

// A march of balls with R = m = 1.
template <class March>
struct OfUnitBalls {
    template <int kSign>
    static long loop(FrameState& s, const ImpactParams& p, int n) {
        ImpactParams unit = p;
        unit.R = unit.m = 1.0;
        spins_to_speeds(s, p.R);
        const long steps = March::template loop<kSign>(s, unit, n);
        speeds_to_spins(s, p.R);
        return steps;
    }
};

using Precomputed = OfUnitBalls<WithStep<PrecomputedStep>>;

}  // namespace
}  // namespace carom::kernel
