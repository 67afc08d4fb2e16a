// Section 3.7: SIMD in static single assignment. A component of both balls shares a register, both sides are
// computed and one is selected by a mask, every value is assigned once, and only the stop test branches.
#pragma once

#include <immintrin.h>

#include "ladder/packed_blocks.h"

namespace carom::kernel {
namespace {

struct SimdSsa {
    template <int kSign>
    static long loop(FrameState& s, const ImpactParams& p, int n) {
        const Constants k = constants<kSign>(s, p, n);
        const double h = k.dP / k.m;
        // vx = (v1x, v2x), vy = (v1y, v2y), wx = (R w1x, R w2x), wy likewise; z = R (w1z + w2z) is one
        // number.
        __m128d vx = _mm_set_pd(s.v2x, s.v1x), vy = _mm_set_pd(s.v2y, s.v1y);
        __m128d wx = _mm_set_pd(k.R * s.w2x, k.R * s.w1x), wy = _mm_set_pd(k.R * s.w2y, k.R * s.w1y);
        double z = k.R * (s.w1z + s.w2z), sum_J1 = 0.0, W = 0.0, v_n = high(vy) - low(vy), W_f = 0.0;
        bool compressing = true;
        long steps = 0;
        const __m128d push = _mm_set_pd(h, -h), spin = _mm_set1_pd(2.5), zero = _mm_setzero_pd();
        const __m128d floor = _mm_set1_pd(k.u_floor);
        const __m128d mu = _mm_set_pd(-k.mu_s2, k.mu_s1);
        while (v_n < 0.0 || compressing || W < W_f) {
            if (++steps > k.limit) return -1;
            const double c_x = low(vx) - high(vx) - z, c_z = low(wx) + high(wx);
            const __m128d u_x = kSign > 0 ? _mm_add_pd(vx, wy) : _mm_sub_pd(vx, wy);
            const __m128d u_y = kSign > 0 ? _mm_sub_pd(vy, wx) : _mm_add_pd(vy, wx);
            const __m128d u = _mm_sqrt_pd(_mm_add_pd(_mm_mul_pd(u_x, u_x), _mm_mul_pd(u_y, u_y)));
            const double c = square_root(c_x * c_x + c_z * c_z);
            const double friction = c < kSlipCutoff ? 0.0 : -k.mu_b * h / c;
            const double J1 = friction * c_x, J2 = absolute(c_z) < kSlipCutoff ? 0.0 : friction * c_z;
            // Ball 2 if J2 > 0, ball 1 if J2 < 0; a cloth slip of zero may yield 0/0, which its mask clears.
            const __m128d J = _mm_set1_pd(J2);
            const __m128d pressed = _mm_cmpgt_pd(_mm_mul_pd(J, _mm_set_pd(1.0, -1.0)), zero);
            const __m128d active = _mm_and_pd(pressed, _mm_cmpgt_pd(u, floor));
            const __m128d cloth = _mm_and_pd(active, _mm_div_pd(_mm_mul_pd(mu, J), u));
            const __m128d Q_x = _mm_mul_pd(cloth, u_x), Q_y = _mm_mul_pd(cloth, u_y);
            const __m128d next_vx = _mm_add_pd(vx, _mm_add_pd(_mm_set_pd(-J1, J1), Q_x));
            const __m128d next_vy = _mm_add_pd(vy, _mm_add_pd(push, Q_y));
            const __m128d next_wx = _mm_add_pd(wx, _mm_mul_pd(spin, _mm_add_pd(J, Q_y)));
            const __m128d next_wy = _mm_sub_pd(wy, _mm_mul_pd(spin, Q_x));
            const double next_v_n = high(next_vy) - low(next_vy);
            W += 0.5 * k.dP * absolute(v_n + next_v_n);
            const bool ends = compressing && next_v_n > 0.0;
            W_f = ends ? (1.0 + k.e_b * k.e_b) * W : W_f;
            compressing = compressing && !ends;
            z -= 5.0 * J1;
            sum_J1 += J1;
            vx = next_vx;
            vy = next_vy;
            wx = next_wx;
            wy = next_wy;
            v_n = next_v_n;
        }
        const double dw_z = -2.5 * sum_J1 / k.R;
        s = {low(vx),  low(vy),  low(wx) / k.R,  low(wy) / k.R,  s.w1z + dw_z,
             high(vx), high(vy), high(wx) / k.R, high(wy) / k.R, s.w2z + dw_z};
        return steps;
    }
};

}  // namespace
}  // namespace carom::kernel
