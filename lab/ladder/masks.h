// Section 3.3: no branches. A condition becomes a bit mask that clears inapplicable numbers.
#pragma once

#include "ladder/step_loops.h"

namespace carom::kernel {
namespace {

inline double keep(bool condition, double x) {
    return __builtin_bit_cast(double,
                              __builtin_bit_cast(unsigned long, x) & -static_cast<unsigned long>(condition));
}

struct MasksStep {
    template <int kSign>
    static void step(FrameState& s, const Constants& k) {
        const double c_x = s.v1x - s.v2x - k.R * (s.w1z + s.w2z);
        const double c_z = k.R * (s.w1x + s.w2x);
        const double u1x = s.v1x + kSign * k.R * s.w1y, u1y = s.v1y - kSign * k.R * s.w1x;
        const double u2x = s.v2x + kSign * k.R * s.w2y, u2y = s.v2y - kSign * k.R * s.w2x;
        const double c = square_root(c_x * c_x + c_z * c_z);
        const double u1 = square_root(u1x * u1x + u1y * u1y), u2 = square_root(u2x * u2x + u2y * u2y);
        const bool slips = c >= kSlipCutoff;
        const double friction = keep(slips, -k.mu_b * k.dP / c);
        Impulses d;
        d.dP1 = friction * c_x;
        d.dP2 = keep(slips & (absolute(c_z) >= kSlipCutoff), friction * c_z);
        const bool second = d.dP2 > 0.0;
        const double cloth1 = keep(!second & (u1 > k.u_floor), k.mu_s1 * d.dP2 / u1);
        const double cloth2 = keep(second & (u2 > k.u_floor), -k.mu_s2 * d.dP2 / u2);
        d.dPix = cloth1 * u1x;
        d.dPiy = cloth1 * u1y;
        d.dPjx = cloth2 * u2x;
        d.dPjy = cloth2 * u2y;
        apply(s, k, d);
    }
};

using Masks = WithStep<MasksStep>;

}  // namespace
}  // namespace carom::kernel
