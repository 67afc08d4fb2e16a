// Section 3.3: the baseline's branches with hints. Slip is the normal case; no slip and zero cloth slip are
// exceptions.
#pragma once

#include "ladder/step_loops.h"

namespace carom::kernel {
namespace {

struct BranchHintsStep {
    template <int kSign>
    static void step(FrameState& s, const Constants& k) {
        const double c_x = s.v1x - s.v2x - k.R * (s.w1z + s.w2z);
        const double c_z = k.R * (s.w1x + s.w2x);
        const double c = square_root(c_x * c_x + c_z * c_z);
        Impulses d;
        if (!(c < kSlipCutoff)) [[likely]] {
            d.dP1 = -k.mu_b * k.dP * c_x / c;
            if (!(absolute(c_z) < kSlipCutoff)) [[likely]] {
                d.dP2 = -k.mu_b * k.dP * c_z / c;
                if (d.dP2 > 0.0) {
                    const double u_x = s.v2x + kSign * k.R * s.w2y, u_y = s.v2y - kSign * k.R * s.w2x;
                    const double u = square_root(u_x * u_x + u_y * u_y);
                    if (u > k.u_floor) [[likely]] {
                        d.dPjx = -k.mu_s2 * (u_x / u) * d.dP2;
                        d.dPjy = -k.mu_s2 * (u_y / u) * d.dP2;
                    }
                } else {
                    const double u_x = s.v1x + kSign * k.R * s.w1y, u_y = s.v1y - kSign * k.R * s.w1x;
                    const double u = square_root(u_x * u_x + u_y * u_y);
                    if (u > k.u_floor) [[likely]] {
                        d.dPix = k.mu_s1 * (u_x / u) * d.dP2;
                        d.dPiy = k.mu_s1 * (u_y / u) * d.dP2;
                    }
                }
            }
        }
        apply(s, k, d);
    }
};

using BranchHints = WithStep<BranchHintsStep>;
using TwoStage = InTwoStages<BranchHintsStep>;

}  // namespace
}  // namespace carom::kernel
