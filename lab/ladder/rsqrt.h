// Section 3.2: the baseline's step with reciprocal lengths from rsqrtss instead of square root and division.
#pragma once

#include "ladder/roots.h"
#include "ladder/step_loops.h"

namespace carom::kernel {
namespace {

template <class Root>
struct InverseStep {
    template <int kSign>
    static void step(FrameState& s, const Constants& k) {
        const double c_x = s.v1x - s.v2x - k.R * (s.w1z + s.w2z);
        const double c_z = k.R * (s.w1x + s.w2x);
        const double square = c_x * c_x + c_z * c_z;
        Impulses d;
        if (!(square < kSlipCutoff * kSlipCutoff)) {
            const double friction = -k.mu_b * k.dP * Root::inverse(square);
            d.dP1 = friction * c_x;
            if (!(absolute(c_z) < kSlipCutoff)) {
                d.dP2 = friction * c_z;
                if (d.dP2 > 0.0) {
                    const double u_x = s.v2x + kSign * k.R * s.w2y, u_y = s.v2y - kSign * k.R * s.w2x;
                    const double u = u_x * u_x + u_y * u_y;
                    if (u > k.u_floor * k.u_floor) {
                        const double cloth = -k.mu_s2 * d.dP2 * Root::inverse(u);
                        d.dPjx = cloth * u_x;
                        d.dPjy = cloth * u_y;
                    }
                } else {
                    const double u_x = s.v1x + kSign * k.R * s.w1y, u_y = s.v1y - kSign * k.R * s.w1x;
                    const double u = u_x * u_x + u_y * u_y;
                    if (u > k.u_floor * k.u_floor) {
                        const double cloth = k.mu_s1 * d.dP2 * Root::inverse(u);
                        d.dPix = cloth * u_x;
                        d.dPiy = cloth * u_y;
                    }
                }
            }
        }
        apply(s, k, d);
    }
};

// the unrefined 12 bits, whose error is the reason for Newton steps
using RsqrtRaw = WithStep<InverseStep<RawRoot>>;
// The published variant yields NaN at zero slip; here a zero slip uses no root.
using RsqrtNewton = WithStep<InverseStep<NewtonRoot>>;

}  // namespace
}  // namespace carom::kernel
