// Section 3.8 and beyond: independent impacts in the lanes of a vector of W lanes, which fills a register. U
// vectors are interleaved, so that the latency of one hides behind the others. The step is that of reduced.h,
// with the slip (a, b) of the pressed ball and (c, d) of the other; a lane whose vertical slip changes sign
// swaps them. Lanes share no data: each result depends only on its own impact.
#pragma once

#include "ladder/batch_arrays.h"
#include "march/reduced.h"
#include "simd.h"

namespace carom::kernel {
namespace {

// 12 bits from rsqrtps, or 14 from AVX-512.
CAROM_INLINE Pack<4> approximate_rsqrt(Pack<4> v) {
#if defined(__AVX512VL__)
    return (Pack<4>)_mm256_rsqrt14_pd((__m256d)v);
#else
    return (Pack<4>)_mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps((__m256d)v)));
#endif
}

// madd is a b + c, nmadd is c - a b.
struct SeparateArithmetic {
    template <class V>
    static V madd(V a, V b, V c) {
        return a * b + c;
    }
    template <class V>
    static V nmadd(V a, V b, V c) {
        return c - a * b;
    }
};

struct FusedArithmetic {
    static Pack<4> madd(Pack<4> a, Pack<4> b, Pack<4> c) {
        return (Pack<4>)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
    }
    static Pack<4> nmadd(Pack<4> a, Pack<4> b, Pack<4> c) {
        return (Pack<4>)_mm256_fnmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
    }
#if defined(__AVX512F__)
    static Pack<8> madd(Pack<8> a, Pack<8> b, Pack<8> c) {
        return (Pack<8>)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
    }
    static Pack<8> nmadd(Pack<8> a, Pack<8> b, Pack<8> c) {
        return (Pack<8>)_mm512_fnmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
    }
#endif
};

// W impacts in progress.
template <int W>
struct Lanes {
    using V = Pack<W>;
    V x, size, a, b, c, d, v_n, sum_v;  // sum_v: the sum of v_n over the steps, for the work
    V h, h2, mu_h, floor2;              // h2 = 2 h; a lane that has ended has zeros here, so nothing moves
    V mu_hs, mu_other;                  // mu_b h times mu_s of the pressed and of the other ball
    Mask<W> pressed2;                   // all bits where ball 2 is pressed
    V c_root, c_before, c_first, u_root, u_before, u_first;  // reciprocal lengths of the last three steps
};

template <int W, class Roots, class Arithmetic, int kSign>
inline void lane_step(Lanes<W>& s) {
    using V = Pack<W>;
    using A = Arithmetic;
    constexpr double kKappa = 1.0 - 2.5 * kSign;
    const V zero{};
    const V c2 = A::madd(s.x, s.x, s.size * s.size), u2 = A::madd(s.a, s.a, s.b * s.b);
    // Everything independent of the roots comes first, leaving only two operations between the roots and the
    // next step.
    const V x1 = s.mu_h * s.x, t1 = s.mu_h * s.size, q1 = s.mu_hs * s.size, a1 = q1 * s.a, b1 = q1 * s.b;
    const V b_pushed = s.b + s.h, d_pushed = s.d + s.h, v_pushed = s.v_n + s.h2;
    V C, U;  // 1/c and 1/u; 0 if the slip has no direction: below the published cutoff, or below the floor
    Roots::template take<W, A>(s, c2, u2, C, U);
    const V CU = C * U;
    s.sum_v += s.v_n;
    s.x = A::madd(CU, a1, A::nmadd(C, 7.0 * x1, s.x));
    s.size = A::madd(CU, 2.5 * b1, A::nmadd(C, 5.0 * t1, s.size));
    s.a = A::nmadd(CU, kKappa * a1, A::madd(C, x1, s.a));
    s.b = A::nmadd(CU, kKappa * b1, A::nmadd(C, (2.5 * kSign) * t1, b_pushed));
    s.c = A::madd(C, x1, s.c);
    s.d = A::madd(C, (2.5 * kSign) * t1, d_pushed);
    s.v_n = A::nmadd(CU, b1, v_pushed);
    if (bits_less(s.size, zero) != 0) [[unlikely]] {
        const Mask<W> flips = s.size < zero;
        const V a = s.a, b = s.b, mu = s.mu_hs;
        s.a = select(flips, s.c, s.a);
        s.b = select(flips, s.d, s.b);
        s.c = select(flips, a, s.c);
        s.d = select(flips, b, s.d);
        s.mu_hs = select(flips, s.mu_other, s.mu_hs);
        s.mu_other = select(flips, mu, s.mu_other);
        s.size = select(flips, -s.size, s.size);
        s.pressed2 ^= flips;
    }
}

// Square root and division, as in the baseline.
struct LaneExactRoots {
    template <int W, class A, class S, class V>
    static void take(S& s, V c2, V u2, V& c, V& u) {
        c = select(c2 >= kSlipCutoff * kSlipCutoff, 1.0 / square_root(c2), V{});
        u = select(u2 > s.floor2, 1.0 / square_root(u2), V{});
    }
};

// The approximate instruction and two Newton steps. Lanes whose square does not fit into a float, or is zero,
// use square root and division.
struct LaneRsqrtRoots {
    template <int W, class A, class S, class V>
    static void take(S& s, V c2, V u2, V& c, V& u) {
        c = select(c2 >= kSlipCutoff * kSlipCutoff, refined(c2), V{});
        u = select(u2 > s.floor2, refined(u2), V{});
    }
    template <class V>
    static V refined(V square) {
        V y = approximate_rsqrt(square);
        const V half = 0.5 * square;
        y = y * (1.5 - half * y * y);
        y = y * (1.5 - half * y * y);
        const auto fits = (square > 1e-30) & (square < 1e30);
        if (any(~fits)) [[unlikely]]
            return select(fits, y, 1.0 / square_root(square));
        return y;
    }
};

// No root at all: the reciprocal length is carried from step to step, extrapolated quadratically and
// corrected by the series of (1 - e)^(-1/2). A lane with e above 1e-4 (at the start, near stick, after a
// change of side) uses square root and division. The remaining error, 35/128 e^4, is below an ulp.
struct LaneCarriedRoots {
    template <int W, class A, class S, class V>
    static void take(S& s, V c2, V u2, V& c, V& u) {
        V e_c, e_u;
        c = carried<W, A>(c2, s.c_root, s.c_before, s.c_first, e_c);
        u = carried<W, A>(u2, s.u_root, s.u_before, s.u_first, e_u);
        if (!all_below(A::madd(e_c, e_c, e_u * e_u), 1e-8)) [[unlikely]] {
            c = select(e_c * e_c < 1e-8, c,
                       select(c2 >= kSlipCutoff * kSlipCutoff, 1.0 / square_root(c2), V{}));
            u = select(e_u * e_u < 1e-8, u, select(u2 > s.floor2, 1.0 / square_root(u2), V{}));
        }
        s.c_root = c;
        s.u_root = u;
    }
    // Extrapolates from the last three values: 3 (last - before) + first.
    template <int W, class A, class V>
    static V carried(V square, V last, V& before, V& first, V& e) {
        const V seed = A::madd(broadcast<W>(3.0), last - before, first);
        first = before;
        before = last;
        e = A::nmadd(square * seed, seed, broadcast<W>(1.0));
        const V series = A::madd(A::madd(broadcast<W>(0.3125), e, broadcast<W>(0.375)), e, broadcast<W>(0.5));
        return A::madd(seed * e, series, seed);
    }
};

// A lane's data besides its vectors.
struct LaneRecord : BatchImpact {
    Reduced start;
    ReducedConstants k;
    // In units of W/h: the sum of (v(m) + v(m+1)) / 2 at the end of compression, the work, and the work to
    // reach.
    double V_cross, W, W_f;
    bool active, compressing;
};

template <int W>
void fill_lane(Lanes<W>& s, int i, const LaneRecord& r) {
    const int pressed = r.start.z < 0.0;
    s.x[i] = r.start.x;
    s.size[i] = absolute(r.start.z);
    s.a[i] = r.start.Ux[pressed];
    s.b[i] = r.start.Uy[pressed];
    s.c[i] = r.start.Ux[1 - pressed];
    s.d[i] = r.start.Uy[1 - pressed];
    s.v_n[i] = r.start.v_n;
    s.h[i] = r.k.h;
    s.mu_h[i] = r.k.mu_h;
    s.h2[i] = 2.0 * r.k.h;
    s.mu_hs[i] = r.k.mu_h * r.k.mu_s[pressed];
    s.mu_other[i] = r.k.mu_h * r.k.mu_s[1 - pressed];
    s.floor2[i] = r.k.u_floor * r.k.u_floor;
    s.pressed2[i] = -static_cast<long>(pressed);
}

template <int W>
Reduced lane_state(Lanes<W>& s, int i) {
    const int pressed = s.pressed2[i] != 0;
    Reduced r;
    r.x = s.x[i];
    r.z = pressed ? -s.size[i] : s.size[i];
    r.v_n = s.v_n[i];
    r.Ux[pressed] = s.a[i];
    r.Uy[pressed] = s.b[i];
    r.Ux[1 - pressed] = s.c[i];
    r.Uy[1 - pressed] = s.d[i];
    return r;
}

}  // namespace
}  // namespace carom::kernel
