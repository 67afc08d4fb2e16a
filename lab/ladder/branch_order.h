// Section 3.3: another order of the branches. The first decides, by the sign of the vertical slip, which ball
// is pressed onto the cloth; the exceptions (no slip at all) are last.
#pragma once

#include "ladder/step_loops.h"

namespace carom::kernel {
namespace {

struct BranchOrderStep {
    template <int kSign>
    static void step(FrameState& s, const Constants& k) {
        const double c_x = s.v1x - s.v2x - k.R * (s.w1z + s.w2z);
        const double c_z = k.R * (s.w1x + s.w2x);
        const double c = square_root(c_x * c_x + c_z * c_z);
        Impulses d;
        if (c_z <= -kSlipCutoff) {  // so |c| is at least as large
            d.dP1 = -k.mu_b * k.dP * c_x / c;
            d.dP2 = -k.mu_b * k.dP * c_z / c;
            const double u_x = s.v2x + kSign * k.R * s.w2y, u_y = s.v2y - kSign * k.R * s.w2x;
            const double u = square_root(u_x * u_x + u_y * u_y);
            if (u > k.u_floor) {
                d.dPjx = -k.mu_s2 * (u_x / u) * d.dP2;
                d.dPjy = -k.mu_s2 * (u_y / u) * d.dP2;
            }
        } else if (c_z >= kSlipCutoff) {
            d.dP1 = -k.mu_b * k.dP * c_x / c;
            d.dP2 = -k.mu_b * k.dP * c_z / c;
            const double u_x = s.v1x + kSign * k.R * s.w1y, u_y = s.v1y - kSign * k.R * s.w1x;
            const double u = square_root(u_x * u_x + u_y * u_y);
            if (u > k.u_floor) {
                d.dPix = k.mu_s1 * (u_x / u) * d.dP2;
                d.dPiy = k.mu_s1 * (u_y / u) * d.dP2;
            }
        } else if (!(c < kSlipCutoff)) {
            d.dP1 = -k.mu_b * k.dP * c_x / c;
        }
        apply(s, k, d);
    }
};

using BranchOrder = WithStep<BranchOrderStep>;

}  // namespace
}  // namespace carom::kernel
