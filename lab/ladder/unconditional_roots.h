// Section 3.3, inverted branches with unconditional roots: both cloth slips and all three roots are computed
// before the first branch, so that the roots of the cloth slips do not wait for the decision which ball is
// pressed.
#pragma once

#include "ladder/step_loops.h"

namespace carom::kernel {
namespace {

struct UnconditionalRootsStep {
    template <int kSign>
    static void step(FrameState& s, const Constants& k) {
        const double c_x = s.v1x - s.v2x - k.R * (s.w1z + s.w2z);
        const double c_z = k.R * (s.w1x + s.w2x);
        const double u1x = s.v1x + kSign * k.R * s.w1y, u1y = s.v1y - kSign * k.R * s.w1x;
        const double u2x = s.v2x + kSign * k.R * s.w2y, u2y = s.v2y - kSign * k.R * s.w2x;
        const double c = square_root(c_x * c_x + c_z * c_z);
        const double u1 = square_root(u1x * u1x + u1y * u1y), u2 = square_root(u2x * u2x + u2y * u2y);
        const bool slips = !(c < kSlipCutoff), turns = slips && !(absolute(c_z) < kSlipCutoff);
        const double friction = slips ? -k.mu_b * k.dP / c : 0.0;
        Impulses d;
        d.dP1 = friction * c_x;
        d.dP2 = turns ? friction * c_z : 0.0;
        if (d.dP2 > 0.0) {
            const double cloth = u2 > k.u_floor ? -k.mu_s2 * d.dP2 / u2 : 0.0;
            d.dPjx = cloth * u2x;
            d.dPjy = cloth * u2y;
        } else {
            const double cloth = u1 > k.u_floor ? k.mu_s1 * d.dP2 / u1 : 0.0;
            d.dPix = cloth * u1x;
            d.dPiy = cloth * u1y;
        }
        apply(s, k, d);
    }
};

using UnconditionalRoots = WithStep<UnconditionalRootsStep>;

}  // namespace
}  // namespace carom::kernel
