// Section 3.2: fewer square roots. The cutoff is tested on the squared slip, and a slip without friction
// needs no root.
#pragma once

#include "ladder/step_loops.h"

namespace carom::kernel {
namespace {

struct FewerRootsStep {
    template <int kSign>
    static void step(FrameState& s, const Constants& k) {
        const double c_x = s.v1x - s.v2x - k.R * (s.w1z + s.w2z);
        const double c_z = k.R * (s.w1x + s.w2x);
        const double square = c_x * c_x + c_z * c_z;
        Impulses d;
        if (k.mu_b > 0.0 && !(square < kSlipCutoff * kSlipCutoff)) {
            const double friction = -k.mu_b * k.dP / square_root(square);
            d.dP1 = friction * c_x;
            if (!(absolute(c_z) < kSlipCutoff)) {
                d.dP2 = friction * c_z;
                const bool second = d.dP2 > 0.0;
                const double mu = second ? k.mu_s2 : k.mu_s1;
                if (mu > 0.0) {
                    const double u_x = second ? s.v2x + kSign * k.R * s.w2y : s.v1x + kSign * k.R * s.w1y;
                    const double u_y = second ? s.v2y - kSign * k.R * s.w2x : s.v1y - kSign * k.R * s.w1x;
                    const double u = u_x * u_x + u_y * u_y;
                    const double cloth = u > k.u_floor * k.u_floor ? mu * d.dP2 / square_root(u) : 0.0;
                    (second ? d.dPjx : d.dPix) = second ? -cloth * u_x : cloth * u_x;
                    (second ? d.dPjy : d.dPiy) = second ? -cloth * u_y : cloth * u_y;
                }
            }
        }
        apply(s, k, d);
    }
};

using FewerRoots = WithStep<FewerRootsStep>;

}  // namespace
}  // namespace carom::kernel
