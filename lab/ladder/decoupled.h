// Beyond the paper: every step is executed, and none waits for a root. The state is two pairs, A = [x, a] and
// B = [|z|, b], so that A A + B B is both squares at once; T = [1/c, 1/u] / sqrt(2), so that f = 1/2 - |.|^2
// T^2 is the relative error of T.
//
// A step's root is extrapolated from the corrected roots of earlier steps and used unchanged. Its error T f
// corrects the history, and is added to the root of the step kLag later: no step waits for its own
// correction, and only the corrections of a run's last steps are lost. The chain from step to step is
// therefore two sums and a product; the roots are computed beside it. The error is tested once every kBlock
// steps. A block whose error is too large is repeated with slow steps: by the series, or by square root and
// division (at the start, near u = 0 or c = 0).
#pragma once

#include "ladder/stretches.h"

namespace carom::kernel {
namespace {

struct DecoupledMarch {
    static constexpr int kLag = 2, kBlock = 3;
    static constexpr double kFastError = 5e-7;    // largest |f| in a block; 3/2 f^2 is neglected
    static constexpr double kEnterError = 5e-8;   // largest |f| of a slow step after which a block is tried
    static constexpr double kSeriesError = 5e-4;  // largest |f| for the series, whose error is 63/8 f^5
    static constexpr double kRootHalf = 0.70710678118654752440;

    struct State {
        __m128d A, B, sum_B;
        __m128d R[5];  // corrected roots of the last five steps, the newest first
    };
    struct Factors {
        __m128d push, x_P, z_P, a_Q, b_Q;
    };

    static __m128d low(__m128d v) { return _mm_movedup_pd(v); }
    static __m128d high(__m128d v) { return _mm_unpackhi_pd(v, v); }
    static __m128d squares(const State& s) { return _mm_fmadd_pd(s.B, s.B, _mm_mul_pd(s.A, s.A)); }

    // The step with these roots.
    static void step(State& s, __m128d T, const Factors& k) {
        const __m128d C = low(T), CU = _mm_mul_pd(C, high(T));
        const __m128d x = low(s.A), a = high(s.A), z = low(s.B), b = high(s.B);
        const __m128d w = _mm_mul_pd(z, CU);
        s.sum_B = _mm_add_pd(s.sum_B, s.B);
        s.A = _mm_fmadd_pd(w, _mm_mul_pd(a, k.a_Q), _mm_fmadd_pd(x, _mm_mul_pd(C, k.x_P), s.A));
        s.B = _mm_fmadd_pd(w, _mm_mul_pd(b, k.b_Q),
                           _mm_fmadd_pd(z, _mm_mul_pd(C, k.z_P), _mm_add_pd(s.B, k.push)));
    }

    static __m128d extrapolated(const __m128d (&R)[5], double c0, double c1, double c2, double c3,
                                double c4) {
        __m128d T = _mm_mul_pd(_mm_set1_pd(c4), R[4]);
        T = _mm_fmadd_pd(_mm_set1_pd(c3), R[3], T);
        T = _mm_fmadd_pd(_mm_set1_pd(c2), R[2], T);
        T = _mm_fmadd_pd(_mm_set1_pd(c1), R[1], T);
        return _mm_fmadd_pd(_mm_set1_pd(c0), R[0], T);
    }
    static __m128d one_ahead(const __m128d (&R)[5]) { return extrapolated(R, 5, -10, 10, -5, 1); }
    static __m128d two_ahead(const __m128d (&R)[5]) { return extrapolated(R, 15, -40, 45, -24, 5); }

    static void remember(State& s, __m128d R) {
        s.R[4] = s.R[3];
        s.R[3] = s.R[2];
        s.R[2] = s.R[1];
        s.R[1] = s.R[0];
        s.R[0] = R;
    }

    // Values that fast steps carry besides the state.
    struct Ahead {
        __m128d estimate[kLag], used[kLag];
    };

    static bool block(State& s, Ahead& next, const Factors& k) {
        __m128d errors = _mm_setzero_pd();
        CAROM_LOOP_BEGIN("decoupled");
#pragma GCC unroll 16
        for (int m = 0; m < kBlock; ++m) {
            const __m128d T = next.estimate[0], used = next.used[0];
            const __m128d f = _mm_fnmadd_pd(squares(s), _mm_mul_pd(T, T), _mm_set1_pd(0.5));
            step(s, used, k);
            const __m128d D = _mm_mul_pd(T, f);
            errors = _mm_fmadd_pd(f, f, errors);
            remember(s, _mm_add_pd(T, D));
            next.estimate[0] = next.estimate[1];
            next.used[0] = next.used[1];
            next.estimate[1] = two_ahead(s.R);
            next.used[1] = _mm_add_pd(next.estimate[1], D);
        }
        CAROM_LOOP_END("decoupled");
        return _mm_movemask_pd(_mm_cmp_pd(errors, _mm_set1_pd(kFastError * kFastError), _CMP_NLT_UQ)) == 0;
    }

    static bool within(__m128d T, __m128d f, double bound) {
        const __m128d size = _mm_andnot_pd(_mm_set1_pd(-0.0), f);
        const __m128d small = _mm_cmp_pd(size, _mm_set1_pd(bound), _CMP_LT_OQ);
        // A negative T may also have the correct square.
        return _mm_movemask_pd(_mm_and_pd(small, _mm_cmp_pd(T, _mm_setzero_pd(), _CMP_GT_OQ))) == 3;
    }

    // A step with its own roots. Returns true if the next steps may be fast.
    static bool slow_step(State& s, const Factors& k, double c_floor, double u_floor) {
        const __m128d T = one_ahead(s.R), square = squares(s);
        const __m128d f = _mm_fnmadd_pd(square, _mm_mul_pd(T, T), _mm_set1_pd(0.5));
        __m128d R;
        if (within(T, f, kSeriesError)) {
            // T (1 - 2 f)^(-1/2)
            __m128d series = _mm_fmadd_pd(_mm_set1_pd(4.375), f, _mm_set1_pd(2.5));
            series = _mm_fmadd_pd(series, f, _mm_set1_pd(1.5));
            series = _mm_fmadd_pd(series, f, _mm_set1_pd(1.0));
            R = _mm_fmadd_pd(_mm_mul_pd(T, f), series, T);
        } else {
            const __m128d directed = _mm_cmp_pd(square, _mm_set_pd(u_floor, c_floor), _CMP_GT_OQ);
            R = _mm_and_pd(directed, _mm_div_pd(_mm_set1_pd(kRootHalf), _mm_sqrt_pd(square)));
        }
        step(s, R, k);
        remember(s, R);
        return within(T, f, kEnterError);
    }

    template <int kSign>
    static void march(Stretch& in, const StretchConstants& c, long count) {
        constexpr double kKappa = 1.0 - 2.5 * kSign, kTwo = 1.0 / kRootHalf;
        const double P = kTwo * c.mu_h, Q = 2.0 * c.mu_hs;
        const Factors k{_mm_set_pd(c.h, 0.0), _mm_set_pd(P, -7.0 * P), _mm_set_pd(-2.5 * kSign * P, -5.0 * P),
                        _mm_set_pd(-kKappa * Q, Q), _mm_set_pd(-kKappa * Q, 2.5 * Q)};
        const double c_floor = kSlipCutoff * kSlipCutoff * (1.0 - 0x1p-52), u_floor = c.u_floor * c.u_floor;
        const __m128d zero = _mm_setzero_pd();
        State s{_mm_set_pd(in.a, in.x), _mm_set_pd(in.b, in.z), zero, {zero, zero, zero, zero, zero}};
        // Without a history f is 1/2, and the first steps use exact roots.
        for (long m = 0; m < count;) {
            bool smooth = false;
            for (; m < count && !smooth; ++m) smooth = slow_step(s, k, c_floor, u_floor);
            if (count - m < kBlock) continue;
            Ahead next;
            next.estimate[0] = next.used[0] = one_ahead(s.R);
            next.estimate[1] = next.used[1] = two_ahead(s.R);
            State before = s;
            while (count - m >= kBlock && block(s, next, k)) {
                before = s;
                m += kBlock;
            }
            s = before;
        }
        double A[2], B[2], sum[2];
        _mm_storeu_pd(A, s.A);
        _mm_storeu_pd(B, s.B);
        _mm_storeu_pd(sum, s.sum_B);
        in = {A[0], A[1], B[0], B[1], sum[0], sum[1]};
    }
};

using Decoupled = InStretches<DecoupledMarch>;

}  // namespace
}  // namespace carom::kernel
