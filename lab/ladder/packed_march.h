// Beyond the paper: one impact, every step executed, its reduced state in one register: S = [x, a, |z|, b],
// where (a, b) is the cloth slip of the pressed ball. The reciprocal lengths R = [1/c, 1/u, 1/c, 1/u] limit
// the speed. They are computed
//
//   kExact      by square root and division
//   kSeed       by linear extrapolation, corrected by a series before use
//   kOneAhead   by extrapolation from the last five, used at once; the step is corrected later by terms
//   linear
//               in the error e
//   kTwoAhead   like kOneAhead from values one step older, which also removes the extrapolation from the
//               critical path
//
// A step whose e is too large for its form uses the series, or square root and division (at the start, near
// u = 0 or c = 0).
#pragma once

#include "ladder/stretches.h"

namespace carom::kernel {
namespace {

enum class RootForm { kExact, kSeed, kOneAhead, kTwoAhead };

constexpr double kLateError = 2e-8;    // largest e for the late correction, which neglects 3/8 e^2
constexpr double kSeriesError = 1e-3;  // largest e for the series, which neglects 63/256 e^5

inline __m256d swapped_halves(__m256d a) {
    return _mm256_permute2f128_pd(a, a, 1);
}

inline bool all_within(__m256d e, double bound) {
    const __m256d size = _mm256_andnot_pd(_mm256_set1_pd(-0.0), e);
    return _mm256_movemask_pd(_mm256_cmp_pd(size, _mm256_set1_pd(bound), _CMP_NLT_UQ)) == 0;
}

template <RootForm kForm>
struct PackedMarch {
    // 1/c and 1/u by square root and division; 0 if the slip has no direction.
    static __m256d exact_roots(__m256d S, double u_floor) {
        const __m256d squares = _mm256_mul_pd(S, S), sum = _mm256_add_pd(squares, swapped_halves(squares));
        const double f = u_floor * u_floor, c = kSlipCutoff * kSlipCutoff * (1.0 - 0x1p-52);
        const __m256d directed = _mm256_cmp_pd(sum, _mm256_set_pd(f, c, f, c), _CMP_GT_OQ);
        return _mm256_and_pd(directed, _mm256_div_pd(_mm256_set1_pd(1.0), _mm256_sqrt_pd(sum)));
    }

    static __m256d series(__m256d T, __m256d e) {
        __m256d s = _mm256_fmadd_pd(_mm256_set1_pd(0.2734375), e, _mm256_set1_pd(0.3125));
        s = _mm256_fmadd_pd(s, e, _mm256_set1_pd(0.375));
        s = _mm256_fmadd_pd(s, e, _mm256_set1_pd(0.5));
        return _mm256_fmadd_pd(_mm256_mul_pd(T, e), s, T);
    }

    template <int kSign>
    static void march(Stretch& stretch, const StretchConstants& k, long count) {
        constexpr double kKappa = 1.0 - 2.5 * kSign;
        // The effect of xi and t, and of q, on the state.
        const __m256d by_friction =
            _mm256_mul_pd(_mm256_set1_pd(k.mu_h), _mm256_set_pd(-2.5 * kSign, -5.0, 1.0, -7.0));
        const __m256d by_cloth = _mm256_set_pd(-kKappa, 2.5, -kKappa, 1.0);
        const __m256d half_friction = _mm256_mul_pd(by_friction, _mm256_set1_pd(0.5));
        const __m256d half_cloth = _mm256_mul_pd(by_cloth, _mm256_set1_pd(0.5));
        const __m256d push = _mm256_set_pd(k.h, 0.0, 0.0, 0.0), mu = _mm256_set1_pd(k.mu_hs);
        const __m256d half = _mm256_set1_pd(0.5);
        __m256d S = _mm256_set_pd(stretch.b, stretch.z, stretch.a, stretch.x), sum_S = _mm256_setzero_pd();
        // R of the last steps, the newest first. Initially zero, which yields e = 1: the first steps use
        // exact roots.
        __m256d R1 = _mm256_setzero_pd(), R2 = R1, R3 = R1, R4 = R1, R5 = R1, R6 = R1;
        for (long m = 0; m < count; ++m) {
            CAROM_LOOP_BEGIN("packed march");
            const __m256d pushed = _mm256_add_pd(S, push);
            __m256d R = R1, next = pushed;
            bool late = false;
            if constexpr (kForm == RootForm::kExact) {
                R = exact_roots(S, k.u_floor);
            } else {
                __m256d T;
                if constexpr (kForm == RootForm::kSeed) {
                    T = _mm256_fmsub_pd(_mm256_set1_pd(2.0), R1, R2);
                } else if constexpr (kForm == RootForm::kOneAhead) {
                    T = _mm256_fmadd_pd(_mm256_set1_pd(-5.0), R4, R5);
                    T = _mm256_fmadd_pd(_mm256_set1_pd(10.0), R3, T);
                    T = _mm256_fmadd_pd(_mm256_set1_pd(-10.0), R2, T);
                    T = _mm256_fmadd_pd(_mm256_set1_pd(5.0), R1, T);
                } else {
                    T = _mm256_mul_pd(_mm256_set1_pd(5.0), R6);
                    T = _mm256_fmadd_pd(_mm256_set1_pd(-24.0), R5, T);
                    T = _mm256_fmadd_pd(_mm256_set1_pd(45.0), R4, T);
                    T = _mm256_fmadd_pd(_mm256_set1_pd(-40.0), R3, T);
                    T = _mm256_fmadd_pd(_mm256_set1_pd(15.0), R2, T);
                }
                // e = 1 - |.|^2 T^2. Both copies of a root must have the same bits: a difference between them
                // would not be corrected, and extrapolation would amplify it. Therefore the sum is symmetric
                // in the halves.
                const __m256d ST = _mm256_mul_pd(S, T), rest = _mm256_fnmadd_pd(ST, ST, half);
                const __m256d e = _mm256_add_pd(rest, swapped_halves(rest));
                if constexpr (kForm != RootForm::kSeed) {
                    // The step with T in place of R, then its change by R - T = T e / 2.
                    const __m256d xxzz = _mm256_movedup_pd(ST), aabb = _mm256_permute_pd(ST, 0b1111);
                    const __m256d q =
                        _mm256_mul_pd(_mm256_mul_pd(mu, _mm256_permute4x64_pd(ST, 0b10101010)), aabb);
                    next = _mm256_fmadd_pd(by_friction, xxzz, _mm256_fmadd_pd(by_cloth, q, pushed));
                    const __m256d e_c = _mm256_movedup_pd(e),
                                  e_both = _mm256_add_pd(e, _mm256_permute_pd(e, 0b0101));
                    next = _mm256_fmadd_pd(_mm256_mul_pd(half_friction, xxzz), e_c, next);
                    next = _mm256_fmadd_pd(_mm256_mul_pd(half_cloth, q), e_both,
                                           next);  // last, because e_both comes late
                    R = _mm256_fmadd_pd(_mm256_mul_pd(half, T), e, T);
                    late = all_within(e, kLateError);
                }
                if (!late) [[unlikely]]
                    R = all_within(e, kSeriesError) ? series(T, e) : exact_roots(S, k.u_floor);
            }
            if (!late) [[unlikely]] {
                const __m256d SR = _mm256_mul_pd(S, R);
                const __m256d z = _mm256_permute4x64_pd(SR, 0b10101010), aabb = _mm256_permute_pd(SR, 0b1111);
                const __m256d q = _mm256_mul_pd(_mm256_mul_pd(mu, z), aabb);
                next =
                    _mm256_fmadd_pd(by_friction, _mm256_movedup_pd(SR), _mm256_fmadd_pd(by_cloth, q, pushed));
            }
            sum_S = _mm256_add_pd(sum_S, S);
            S = next;
            R6 = R5;
            R5 = R4;
            R4 = R3;
            R3 = R2;
            R2 = R1;
            R1 = R;
            CAROM_LOOP_END("packed march");
        }
        alignas(32) double end[4], sum[4];
        _mm256_store_pd(end, S);
        _mm256_store_pd(sum, sum_S);
        stretch = {end[0], end[1], end[2], end[3], sum[2], sum[3]};
    }
};

template <RootForm kForm>
using Packed = InStretches<PackedMarch<kForm>>;
using PackedExact = Packed<RootForm::kExact>;
using ExtrapolatedSeed = Packed<RootForm::kSeed>;
using Pipelined = Packed<RootForm::kOneAhead>;
using CarriedRoots = Packed<RootForm::kTwoAhead>;

}  // namespace
}  // namespace carom::kernel
