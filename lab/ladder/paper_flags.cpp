// The baseline's loop, compiled with -Ofast -march=znver3 -ffp-contract=fast as in the paper, in a separate
// file so that only it has these flags. The linker never receives them: with -Ofast it would add start-up
// code that makes the whole process flush subnormal numbers to zero.
#include "ladder/paper_flags.h"
#include "ladder/branch_hints.h"

namespace carom::kernel {

long paper_flags_loop(int sign, double* a, const ImpactParams& params, int n) noexcept {
    FrameState s{a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], a[9]};
    const long steps = sign > 0 ? single_loop<BranchHintsStep, +1>(s, params, n)
                                : single_loop<BranchHintsStep, -1>(s, params, n);
    const double out[10] = {s.v1x, s.v1y, s.w1x, s.w1y, s.w1z, s.v2x, s.v2y, s.w2x, s.w2y, s.w2z};
    for (int i = 0; i < 10; ++i) a[i] = out[i];
    return steps;
}

}  // namespace carom::kernel
