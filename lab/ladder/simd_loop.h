// Section 3.7: SIMD in the whole loop, with one register for each of the vectors v1, w1, v2, w2 (x, y, z, -).
// Most lanes are idle and every dot product needs shuffles, so this variant was slower in the paper.
#pragma once

#include <immintrin.h>

#include "ladder/step_loops.h"

namespace carom::kernel {
namespace {

inline double lane0(__m256d a) {
    return _mm256_cvtsd_f64(a);
}

inline double lane1(__m256d a) {
    return _mm256_cvtsd_f64(_mm256_permute_pd(a, 0b0001));
}

struct SimdLoop {
    template <int kSign>
    static long loop(FrameState& s, const ImpactParams& p, int n) {
        const Constants k = constants<kSign>(s, p, n);
        const double h = k.dP / k.m;
        __m256d v1 = _mm256_set_pd(0.0, 0.0, s.v1y, s.v1x), v2 = _mm256_set_pd(0.0, 0.0, s.v2y, s.v2x);
        __m256d w1 = _mm256_set_pd(0.0, s.w1z, s.w1y, s.w1x), w2 = _mm256_set_pd(0.0, s.w2z, s.w2y, s.w2x);
        const __m256d R = _mm256_set1_pd(k.R), spin = _mm256_set1_pd(k.C * k.m);
        // u = v + sign R (w_y, -w_x, -, -)
        const __m256d turn = _mm256_set_pd(0.0, 0.0, -kSign * k.R, kSign * k.R);
        double W = 0.0, W_f = 0.0, v_n = lane1(v2) - lane1(v1);
        bool compressing = true;
        long steps = 0;
        while (v_n < 0.0 || compressing || W < W_f) {
            if (++steps > k.limit) return -1;
            // The slip at the contact as (c_x, c_z, -, -), from R (w_z, w_x).
            const __m256d sum = _mm256_mul_pd(R, _mm256_add_pd(w1, w2));
            const __m256d zx = _mm256_permute4x64_pd(sum, 0b11110010);  // (w_z, w_x, ...)
            const __m256d dv = _mm256_blend_pd(_mm256_sub_pd(v1, v2), _mm256_setzero_pd(), 0b1110);
            const __m256d slip = _mm256_addsub_pd(dv, zx);  // (dv_x - w_z, 0 + w_x)
            const __m256d squares = _mm256_mul_pd(slip, slip);
            const double c = square_root(lane0(squares) + lane1(squares));
            __m256d J = _mm256_setzero_pd();
            if (!(c < kSlipCutoff)) {
                J = _mm256_mul_pd(_mm256_set1_pd(-k.mu_b * h / c), slip);
                if (absolute(lane1(slip)) < kSlipCutoff) J = _mm256_blend_pd(J, _mm256_setzero_pd(), 0b1110);
            }
            const double J1 = lane0(J), J2 = lane1(J);
            const bool second = J2 > 0.0;
            const __m256d v = second ? v2 : v1, w = second ? w2 : w1;
            const __m256d u = _mm256_add_pd(v, _mm256_mul_pd(turn, _mm256_permute_pd(w, 0b0101)));
            const __m256d u_squares = _mm256_mul_pd(u, u);
            const double length = square_root(lane0(u_squares) + lane1(u_squares));
            const double cloth = length > k.u_floor ? (second ? -k.mu_s2 * J2 : k.mu_s1 * J2) / length : 0.0;
            const __m256d Q =
                _mm256_blend_pd(_mm256_mul_pd(_mm256_set1_pd(cloth), u), _mm256_setzero_pd(), 0b1100);
            const __m256d Q1 = second ? _mm256_setzero_pd() : Q, Q2 = second ? Q : _mm256_setzero_pd();
            const __m256d along = _mm256_set_pd(0.0, 0.0, -h, J1);
            v1 = _mm256_add_pd(v1, _mm256_add_pd(along, Q1));
            v2 = _mm256_add_pd(v2, _mm256_sub_pd(Q2, along));
            // dw = C (J2 + Q_y, -Q_x, -J1)
            const __m256d torque = _mm256_set_pd(0.0, -J1, 0.0, J2);
            const __m256d signs = _mm256_set_pd(0.0, 0.0, -1.0, 1.0);
            w1 = _mm256_add_pd(
                w1, _mm256_mul_pd(
                        spin, _mm256_add_pd(torque, _mm256_mul_pd(signs, _mm256_permute_pd(Q1, 0b0101)))));
            w2 = _mm256_add_pd(
                w2, _mm256_mul_pd(
                        spin, _mm256_add_pd(torque, _mm256_mul_pd(signs, _mm256_permute_pd(Q2, 0b0101)))));
            const double v_n_before = v_n;
            v_n = lane1(v2) - lane1(v1);
            W += 0.5 * k.dP * absolute(v_n_before + v_n);
            if (compressing && v_n > 0.0) {
                compressing = false;
                W_f = (1.0 + k.e_b * k.e_b) * W;
            }
        }
        alignas(32) double a[4][4];
        _mm256_store_pd(a[0], v1);
        _mm256_store_pd(a[1], w1);
        _mm256_store_pd(a[2], v2);
        _mm256_store_pd(a[3], w2);
        s = {a[0][0], a[0][1], a[1][0], a[1][1], a[1][2], a[2][0], a[2][1], a[3][0], a[3][1], a[3][2]};
        return steps;
    }
};

}  // namespace
}  // namespace carom::kernel
