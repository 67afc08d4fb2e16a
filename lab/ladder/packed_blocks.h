// Section 3.5: fewer registers. The five components of both balls are pairs (ball 1, ball 2) in xmm
// registers, in scoped blocks, so that fewer values are live at once.
#pragma once

#include <immintrin.h>

#include "ladder/step_loops.h"

namespace carom::kernel {
namespace {

inline double low(__m128d a) {
    return _mm_cvtsd_f64(a);
}

inline double high(__m128d a) {
    return _mm_cvtsd_f64(_mm_unpackhi_pd(a, a));
}

struct PackedBlocks {
    template <int kSign>
    static long loop(FrameState& s, const ImpactParams& p, int n) {
        const Constants k = constants<kSign>(s, p, n);
        const double h = k.dP / k.m;
        // Pairs (ball 1, ball 2); spins are R w.
        __m128d v_x = _mm_set_pd(s.v2x, s.v1x), v_y = _mm_set_pd(s.v2y, s.v1y);
        __m128d w_x = _mm_set_pd(k.R * s.w2x, k.R * s.w1x), w_y = _mm_set_pd(k.R * s.w2y, k.R * s.w1y);
        __m128d w_z = _mm_set_pd(k.R * s.w2z, k.R * s.w1z);
        const __m128d push = _mm_set_pd(h, -h), spin = _mm_set1_pd(2.5);
        double W = 0.0, W_f = 0.0, v_n = high(v_y) - low(v_y);
        bool compressing = true;
        long steps = 0;
        while (v_n < 0.0 || compressing || W < W_f) {
            if (++steps > k.limit) return -1;
            double J1 = 0.0, J2 = 0.0;
            {
                const double c_x = low(v_x) - high(v_x) - (low(w_z) + high(w_z)), c_z = low(w_x) + high(w_x);
                const double c = square_root(c_x * c_x + c_z * c_z);
                if (!(c < kSlipCutoff)) {
                    const double friction = -k.mu_b * h / c;
                    J1 = friction * c_x;
                    if (!(absolute(c_z) < kSlipCutoff)) J2 = friction * c_z;
                }
            }
            __m128d Q_x = _mm_setzero_pd(), Q_y = _mm_setzero_pd();
            if (J2 != 0.0) {
                const __m128d u_x = kSign > 0 ? _mm_add_pd(v_x, w_y) : _mm_sub_pd(v_x, w_y);
                const __m128d u_y = kSign > 0 ? _mm_sub_pd(v_y, w_x) : _mm_add_pd(v_y, w_x);
                const __m128d u = _mm_sqrt_pd(_mm_add_pd(_mm_mul_pd(u_x, u_x), _mm_mul_pd(u_y, u_y)));
                if (J2 > 0.0) {
                    const double cloth = high(u) > k.u_floor ? -k.mu_s2 * J2 / high(u) : 0.0;
                    Q_x = _mm_mul_pd(_mm_set_pd(cloth, 0.0), u_x);
                    Q_y = _mm_mul_pd(_mm_set_pd(cloth, 0.0), u_y);
                } else {
                    const double cloth = low(u) > k.u_floor ? k.mu_s1 * J2 / low(u) : 0.0;
                    Q_x = _mm_mul_pd(_mm_set_pd(0.0, cloth), u_x);
                    Q_y = _mm_mul_pd(_mm_set_pd(0.0, cloth), u_y);
                }
            }
            v_x = _mm_add_pd(v_x, _mm_add_pd(_mm_set_pd(-J1, J1), Q_x));
            v_y = _mm_add_pd(v_y, _mm_add_pd(push, Q_y));
            w_x = _mm_add_pd(w_x, _mm_mul_pd(spin, _mm_add_pd(_mm_set1_pd(J2), Q_y)));
            w_y = _mm_sub_pd(w_y, _mm_mul_pd(spin, Q_x));
            w_z = _mm_sub_pd(w_z, _mm_mul_pd(spin, _mm_set1_pd(J1)));
            const double v_n_before = v_n;
            v_n = high(v_y) - low(v_y);
            W += 0.5 * k.dP * absolute(v_n_before + v_n);
            if (compressing && v_n > 0.0) {
                compressing = false;
                W_f = (1.0 + k.e_b * k.e_b) * W;
            }
        }
        s = {low(v_x),  low(v_y),  low(w_x) / k.R,  low(w_y) / k.R,  low(w_z) / k.R,
             high(v_x), high(v_y), high(w_x) / k.R, high(w_y) / k.R, high(w_z) / k.R};
        return steps;
    }
};

}  // namespace
}  // namespace carom::kernel
