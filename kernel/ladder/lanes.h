// Section 3.8 and past it: independent impacts in the lanes of a vector. W lanes, U vectors interleaved, so
// that the latency of one hides behind the other. The step is that of reduced.h with the pressed ball's slip
// (a, b) and the other's (c, d); a lane whose vertical slip changes sign swaps them. Lanes share nothing:
// each result depends on its own impact alone.
#pragma once

#include "ladder/lane_vectors.h"
#include "ladder/reduced.h"

namespace carom::kernel {
namespace {

// One group of W lanes in flight.
template <int W>
struct Lanes {
    using V = typename LaneVector<W>::Type;
    using Mask = typename LaneVector<W>::Mask;
    V x, size, a, b, c, d, v_n, sum_v;  // sum_v: of v_n over the steps done, for the work
    V h, h2, mu_h, floor2;              // h2 = 2 h; of a lane that is done all constants are 0: nothing moves
    V mu_hs, mu_other;                  // mu_b h times mu_s of the pressed and of the other ball
    Mask pressed2;                      // all bits where ball 2 is pressed
    V c_root, c_before, c_first, u_root, u_before,
        u_first;  // carried reciprocal lengths of the last three steps
};

template <int W, class Roots, class Arithmetic, int kSign>
inline void lane_step(Lanes<W>& s) {
    using V = typename LaneVector<W>::Type;
    using Mask = typename LaneVector<W>::Mask;
    using A = Arithmetic;
    constexpr double kKappa = 1.0 - 2.5 * kSign;
    const V zero{};
    const V c2 = A::madd(s.x, s.x, s.size * s.size), u2 = A::madd(s.a, s.a, s.b * s.b);
    // Everything that needs no root comes first, so that after the roots only two operations are in the way
    // of the next step.
    const V x1 = s.mu_h * s.x, t1 = s.mu_h * s.size, q1 = s.mu_hs * s.size, a1 = q1 * s.a, b1 = q1 * s.b;
    const V b_pushed = s.b + s.h, d_pushed = s.d + s.h, v_pushed = s.v_n + s.h2;
    V C, U;  // 1/c and 1/u; 0 where the published cutoff, or the floor, says that there is no direction
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
    if (any_below<W>(s.size, zero)) [[unlikely]] {
        const Mask flips = s.size < zero;
        const V a = s.a, b = s.b, mu = s.mu_hs;
        s.a = flips ? s.c : s.a;
        s.b = flips ? s.d : s.b;
        s.c = flips ? a : s.c;
        s.d = flips ? b : s.d;
        s.mu_hs = flips ? s.mu_other : s.mu_hs;
        s.mu_other = flips ? mu : s.mu_other;
        s.size = flips ? -s.size : s.size;
        s.pressed2 ^= flips;
    }
}

// sqrt and division, as the baseline.
struct LaneExactRoots {
    template <int W, class A, class S, class V>
    static void take(S& s, V c2, V u2, V& c, V& u) {
        c = keep_lanes<W>(c2 >= kSlipCutoff * kSlipCutoff, 1.0 / root<W>(c2));
        u = keep_lanes<W>(u2 > s.floor2, 1.0 / root<W>(u2));
    }
};

// Approximate instruction and refinement; squares that it cannot hold, and zero, go to sqrt and division,
// lane by lane.
struct LaneRsqrtRoots {
    template <int W, class A, class S, class V>
    static void take(S& s, V c2, V u2, V& c, V& u) {
        c = keep_lanes<W>(c2 >= kSlipCutoff * kSlipCutoff, refined<W>(c2));
        u = keep_lanes<W>(u2 > s.floor2, refined<W>(u2));
    }
    template <int W, class V>
    static V refined(V square) {
        V y = approximate_rsqrt<W>(square);
        const V half = 0.5 * square;
        y = y * (1.5 - half * y * y);
        y = y * (1.5 - half * y * y);
        const auto fits = (square > 1e-30) & (square < 1e30);
        if (any<W>(~fits)) [[unlikely]]
            return fits ? y : 1.0 / root<W>(square);
        return y;
    }
};

// No root at all: the reciprocal length is carried from step to step, extrapolated quadratically and
// corrected by the series of (1 - e)^(-1/2). Where e is above 1e-4 (starts, near stick, after a flip) the
// lane takes sqrt and division. What remains is 35/128 e^4, below an ulp.
struct LaneCarriedRoots {
    template <int W, class A, class S, class V>
    static void take(S& s, V c2, V u2, V& c, V& u) {
        V e_c, e_u;
        c = carried<W, A>(c2, s.c_root, s.c_before, s.c_first, e_c);
        u = carried<W, A>(u2, s.u_root, s.u_before, s.u_first, e_u);
        if (!all_below<W>(A::madd(e_c, e_c, e_u * e_u), all<W>(1e-8))) [[unlikely]] {
            c = e_c * e_c < 1e-8 ? c : keep_lanes<W>(c2 >= kSlipCutoff * kSlipCutoff, 1.0 / root<W>(c2));
            u = e_u * e_u < 1e-8 ? u : keep_lanes<W>(u2 > s.floor2, 1.0 / root<W>(u2));
        }
        s.c_root = c;
        s.u_root = u;
    }
    // From the last three: 3 (last - before) + first.
    template <int W, class A, class V>
    static V carried(V square, V last, V& before, V& first, V& e) {
        const V seed = A::madd(all<W>(3.0), last - before, first);
        first = before;
        before = last;
        e = A::nmadd(square * seed, seed, all<W>(1.0));
        const V series = A::madd(A::madd(all<W>(0.3125), e, all<W>(0.375)), e, all<W>(0.5));
        return A::madd(seed * e, series, seed);
    }
};

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

// What a lane needs beside its vectors.
struct LaneRecord {
    Ball ball1, ball2;
    ImpactParams params;
    Frame frame;
    FrameState state;
    Reduced start;
    ReducedConstants k;
    double V_cross, W,
        W_f;  // in units of W/h: sum of (v(m) + v(m+1)) / 2 at the end of compression, work, target
    long steps, index;
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
