// Section 4: the paper's compiler flags. The loop is built in a separate file (paper_flags.cpp) with -Ofast
// -march=znver3; validation and projection stay outside, because -Ofast assumes the absence of NaNs.
#pragma once

#include "ladder/step_loops.h"

namespace carom::kernel {

// state: v1x, v1y, w1x, w1y, w1z, then those of ball 2. Returns the number of steps, or -1 at the limit.
long paper_flags_loop(int sign, double* state, const ImpactParams& params, int n) noexcept;

namespace {

struct PaperFlags {
    template <int kSign>
    static long loop(FrameState& s, const ImpactParams& p, int n) {
        double a[10] = {s.v1x, s.v1y, s.w1x, s.w1y, s.w1z, s.v2x, s.v2y, s.w2x, s.w2y, s.w2z};
        const long steps = paper_flags_loop(kSign, a, p, n);
        s = {a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], a[9]};
        return steps;
    }
};

}  // namespace
}  // namespace carom::kernel
