// Section 3.7: SIMD around a scalar loop. Projection and back-projection keep a ball's vector in one
// register; the loop is the baseline's. This can save only the projections' time, less than one per cent at N
// = 1000.
#pragma once

#include <immintrin.h>

#include "ladder/branch_hints.h"

namespace carom::kernel {
namespace {

// Turns (a_x, a_y, a_z, -) by the frame: (a_x f.yy - a_y f.yx, a_x f.yx + a_y f.yy, a_z, -).
inline __m256d turned(const double* a, __m256d along, __m256d across) {
    const __m256d v = _mm256_set_pd(0.0, a[2], a[1], a[0]);
    return _mm256_add_pd(_mm256_mul_pd(v, along), _mm256_mul_pd(_mm256_permute_pd(v, 0b0101), across));
}

inline void simd_outside(const Ball& b1, const Ball& b2, const ImpactParams& p, int n,
                         ImpactResult& out) noexcept {
    if (n < 1) {
        copy_input(b1, b2, ImpactStatus::kBadParameter, out);
        return;
    }
    Frame f;
    FrameState checked;
    if (enter_frame(b1, b2, p, f, checked, out) != ImpactStatus::kOk) return;
    const __m256d along = _mm256_set_pd(0.0, 1.0, f.yy, f.yy), into = _mm256_set_pd(0.0, 0.0, f.yx, -f.yx);
    alignas(32) double a[4][4];
    _mm256_store_pd(a[0], turned(b1.v, along, into));
    _mm256_store_pd(a[1], turned(b1.w, along, into));
    _mm256_store_pd(a[2], turned(b2.v, along, into));
    _mm256_store_pd(a[3], turned(b2.w, along, into));
    FrameState s{a[0][0], a[0][1], a[1][0], a[1][1], a[1][2], a[2][0], a[2][1], a[3][0], a[3][1], a[3][2]};
    const long steps = p.cloth_slip == ClothSlip::kAsPublished ? single_loop<BranchHintsStep, +1>(s, p, n)
                                                               : single_loop<BranchHintsStep, -1>(s, p, n);
    if (steps < 0) {
        copy_input(b1, b2, ImpactStatus::kStepLimit, out);
        return;
    }
    const __m256d back = _mm256_set_pd(0.0, 0.0, -f.yx, f.yx);
    const double in[4][3] = {
        {s.v1x, s.v1y, b1.v[2]}, {s.w1x, s.w1y, s.w1z}, {s.v2x, s.v2y, b2.v[2]}, {s.w2x, s.w2y, s.w2z}};
    double* to[4] = {out.v1, out.w1, out.v2, out.w2};
    for (int k = 0; k < 4; ++k) {
        _mm256_store_pd(a[k], turned(in[k], along, back));
        for (int i = 0; i < 3; ++i) to[k][i] = a[k][i];
    }
    out.steps = steps;
    out.status = ImpactStatus::kOk;
}

}  // namespace
}  // namespace carom::kernel
