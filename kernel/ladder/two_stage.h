// Section 3.3: one loop for compression and one for restitution around the arithmetic of the baseline.
#pragma once

#include "ladder/branch_hints.h"

namespace carom::kernel {
namespace {

struct TwoStage {
    template <int kSign>
    static long loop(FrameState& s, const ImpactParams& p, int n) {
        return two_stage_loop<BranchHintsStep, kSign>(s, p, n);
    }
};

}  // namespace
}  // namespace carom::kernel
