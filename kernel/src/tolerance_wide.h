// One collocation of many impacts at once: a lane is an impact, the nodes stand in arrays.
//
// Legend: tolerance_collocation.h. A lane sees only its own numbers, so that its bits depend neither on the
// width of the registers nor on its neighbours: each keeps the impulses of the sweep at which it converged
// itself.
#pragma once

#include "tolerance_collocation.h"
#include "tolerance_tables.h"

namespace carom::kernel {
namespace {

#if defined(__AVX512F__)
constexpr int kWidth = 8;
#else
constexpr int kWidth = 4;
#endif
typedef double Wide __attribute__((vector_size(8 * kWidth)));
typedef decltype(Wide{} < Wide{}) WideMask;

CAROM_INLINE Wide wide(double x) {
    return Wide{} + x;
}

CAROM_INLINE Wide wide_load(const double* from) {
    Wide v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
}

CAROM_INLINE void wide_store(double* to, Wide v) {
    __builtin_memcpy(to, &v, sizeof v);
}

CAROM_INLINE Wide wide_root(Wide v) {
#if defined(__AVX512F__)
    return (Wide)_mm512_maskz_sqrt_pd(0xff, (__m512d)v);  // the plain form warns in gcc 12
#else
    return square_root(v);
#endif
}

CAROM_INLINE Wide choose(WideMask mask, Wide yes, Wide no) {
    return (Wide)(((WideMask)yes & mask) | ((WideMask)no & ~mask));
}

CAROM_INLINE Wide magnitude(Wide v) {
    return (Wide)((WideMask)v & (WideMask{} + 0x7fffffffffffffffL));
}

CAROM_INLINE bool any(WideMask mask) {
#if defined(__AVX512F__)
    return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask) != 0;
#elif defined(__AVX__)
    return _mm256_testz_si256((__m256i)mask, (__m256i)mask) == 0;
#else
    return ((mask[0] | mask[1]) | (mask[2] | mask[3])) != 0;
#endif
}

template <int N>
struct WideTables;

template <>
struct WideTables<4> {
    static constexpr const double* nodes = kNodes4;
    static constexpr const double* weights = kWeights4;
    static constexpr const double* integral = kIntegral4[0];
    static constexpr const double* top = kTop4;
    static constexpr const double* before = kBefore4[0];
    static constexpr const double* before_late = kBeforeLate4[0];
    static constexpr const double* after_late = kAfterLate4[0];
    static constexpr int sweeps = 24;
};

template <>
struct WideTables<8> {
    static constexpr const double* nodes = kNodes8;
    static constexpr const double* weights = kWeights8;
    static constexpr const double* integral = kIntegral8[0];
    static constexpr const double* top = kTop8;
    static constexpr const double* before = kBefore8[0];
    static constexpr const double* before_late = kBeforeLate8[0];
    static constexpr const double* after_late = kAfterLate8[0];
    static constexpr int sweeps = 24;
};

struct WideModel {
    Wide mu_b, mu_s, e_b;
    double sigma, kappa;
};

struct WideStart {
    Wide x, z, a, b;
};

struct WideResult {
    Wide p, xi, zeta, g_a, g_b;
    Wide sweeps;
    WideMask converged;
};

template <int N>
struct WideNodes {
    Wide x[N], z[N], a[N], b[N], root_s[N], root_u[N], xi[N], zeta[N], g_a[N], g_b[N];
};

// sum_j row[j] f[j], in a written order
template <int N>
CAROM_INLINE Wide wide_dot(const double* row, int stride, const Wide (&f)[N]) {
    Wide even = row[0] * f[0], odd = row[stride] * f[1];
    for (int j = 2; j < N; j += 2) {
        even += row[j * stride] * f[j];
        odd += row[(j + 1) * stride] * f[j + 1];
    }
    return even + odd;
}

template <int N, bool kExact>
CAROM_INLINE Wide wide_forces(const WideModel& m, WideNodes<N>& n) {
    Wide worst = {};
    for (int i = 0; i < N; ++i) {
        const Wide ss = n.x[i] * n.x[i] + n.z[i] * n.z[i], uu = n.a[i] * n.a[i] + n.b[i] * n.b[i];
        if constexpr (kExact) {
            // One division for both roots.
            const Wide s = wide_root(ss), u = wide_root(uu), share = 1.0 / (s * u);
            n.root_s[i] = share * u;
            n.root_u[i] = share * s;
        } else {
            const Wide rs = 1.0 - ss * (n.root_s[i] * n.root_s[i]),
                       ru = 1.0 - uu * (n.root_u[i] * n.root_u[i]);
            n.root_s[i] += n.root_s[i] * (rs * (0.5 + 0.375 * rs));
            n.root_u[i] += n.root_u[i] * (ru * (0.5 + 0.375 * ru));
            worst += rs * rs + ru * ru;
        }
        const Wide by_s = m.mu_b * n.root_s[i];
        n.xi[i] = by_s * n.x[i];
        n.zeta[i] = by_s * n.z[i];
        const Wide by_u = (m.mu_s * n.root_u[i]) * n.zeta[i];
        n.g_a[i] = by_u * n.a[i];
        n.g_b[i] = by_u * n.b[i];
    }
    return worst;
}

template <int N>
CAROM_INLINE Wide wide_slips(const WideModel& m, const WideStart& start, Wide h, WideNodes<N>& n) {
    Wide dx[N], dz[N], da[N], db[N], change = {};
    for (int i = 0; i < N; ++i) {
        dx[i] = n.g_a[i] - 7.0 * n.xi[i];
        dz[i] = 2.5 * n.g_b[i] - 5.0 * n.zeta[i];
        da[i] = n.xi[i] - m.kappa * n.g_a[i];
        db[i] = 1.0 - (m.sigma * n.zeta[i] + m.kappa * n.g_b[i]);
    }
    const Wide mu2 = m.mu_s * m.mu_s;
    for (int i = 0; i < N; ++i) {
        const double* row = WideTables<N>::integral + i;
        const Wide x = start.x + h * wide_dot<N>(row, N, dx), z = start.z + h * wide_dot<N>(row, N, dz);
        const Wide a = start.a + h * wide_dot<N>(row, N, da), b = start.b + h * wide_dot<N>(row, N, db);
        const Wide ex = x - n.x[i], ez = z - n.z[i], ea = a - n.a[i], eb = b - n.b[i];
        change += (ex * ex + ez * ez) * (n.root_s[i] * n.root_s[i]) +
                  mu2 * ((ea * ea + eb * eb) * (n.root_u[i] * n.root_u[i]));
        n.x[i] = x;
        n.z[i] = z;
        n.a[i] = a;
        n.b[i] = b;
    }
    return change;
}

// As EndRows. `t` is where they stand.
template <int N>
struct WideRows {
    Wide t, before[N], before_late[N], after_late[N];
};

template <int N>
CAROM_INLINE Wide wide_polynomial(const double* table, Wide t) {
    Wide value = wide(table[(N - 1) * N]);
    for (int k = N - 2; k >= 0; --k) value = value * t + table[k * N];
    return value;
}

template <int N>
CAROM_INLINE void wide_set_rows(Wide t, WideRows<N>& rows) {
    rows.t = t;
    for (int j = 0; j < N; ++j) {
        rows.before[j] = wide_polynomial<N>(WideTables<N>::before + j, t);
        rows.before_late[j] = wide_polynomial<N>(WideTables<N>::before_late + j, t);
        rows.after_late[j] = wide_polynomial<N>(WideTables<N>::after_late + j, t);
    }
}

// sum_j a[j] b[j]
template <int N>
CAROM_INLINE Wide wide_dot(const Wide (&a)[N], const Wide (&b)[N]) {
    Wide even = a[0] * b[0], odd = a[1] * b[1];
    for (int j = 2; j < N; j += 2) {
        even += a[j] * b[j];
        odd += a[j + 1] * b[j + 1];
    }
    return even + odd;
}

template <int N>
CAROM_INLINE Wide wide_find_end(const WideModel& m, const Wide (&g_b)[N], const WideRows<N>& rows,
                                Wide& p_c) {
    const Wide lost = 1.0 - wide_dot<N>(rows.after_late, g_b);
    const Wide share = 2.0 - wide_dot<N>(rows.before, g_b);
    const Wide both = 1.0 / (lost * share);
    p_c = both * lost;
    const Wide work = p_c * (1.0 - p_c * (1.0 - wide_dot<N>(rows.before_late, g_b)));
    return p_c + m.e_b * wide_root(work * (both * share));
}

// Solves `wanted` lanes; those that do not converge are not in `out.converged`.
template <int N>
CAROM_INLINE void wide_collocate(const WideModel& m, const WideStart& start, WideMask wanted,
                                 double tolerance, WideResult& out) {
    using T = WideTables<N>;
    WideNodes<N> n;
    Wide h = 0.5 * (1.0 + m.e_b), t_c = 2.0 / (1.0 + m.e_b) - 1.0;
    WideRows<N> rows;
    wide_set_rows<N>(t_c, rows);
    const Wide share = m.mu_b / wide_root(start.x * start.x + start.z * start.z);
    const Wide xi0 = share * start.x, zeta0 = share * start.z;
    for (int i = 0; i < N; ++i) {
        const Wide p = h * T::nodes[i];
        n.x[i] = start.x - p * (7.0 * xi0);
        n.z[i] = start.z - p * (5.0 * zeta0);
        n.a[i] = start.a + p * xi0;
        n.b[i] = start.b + p * (1.0 - m.sigma * zeta0);
    }
    wide_forces<N, true>(m, n);
    const Wide mu2 = m.mu_s * m.mu_s, reach2 = (7.0 * m.mu_b * h) * (7.0 * m.mu_b * h);
    Wide steep = {};
    for (int i = 0; i < N; ++i) steep += n.root_s[i] * n.root_s[i] + mu2 * (n.root_u[i] * n.root_u[i]);
    const Wide slope = (reach2 * reach2) * (steep * (1.0 / (N * N))),
               end_slope = 40.0 * ((m.mu_b * m.mu_b) * mu2);
    const double sweep_goal = 8.0 * tolerance * tolerance;
    const Wide root_goal = (0.05 * tolerance * tolerance) / (m.mu_b * m.mu_b);
    Wide dh_before = {};
    WideMask open = wanted;
    out.converged = WideMask{};
    for (int k = 1; k < T::sweeps && any(open); ++k) {
        const Wide change = wide_slips<N>(m, start, h, n);
        Wide p_c;
        const Wide h_new = wide_find_end<N>(m, n.g_b, rows, p_c), dh = h_new - h;
        // Rows are set anew in the lanes where that matters; the others keep theirs, whatever their
        // neighbours do.
        const WideMask moved = open & (magnitude(t_c - rows.t) * m.mu_b * m.mu_s > kRowsGoal * tolerance);
        if (any(moved)) wide_set_rows<N>(choose(moved, t_c, rows.t), rows);
        t_c = 2.0 * p_c / h_new - 1.0;
        h = h_new;
        const Wide r = wide_forces<N, false>(m, n);
        const Wide left = (change + dh * dh * steep) * slope + (dh * dh + dh_before * dh_before) * end_slope;
        const double slow = 1.0 + 0.03125 * (k * k);
        const WideMask now = open & (left * slow <= sweep_goal) & (r * r * r <= root_goal);
        dh_before = dh;
        if (!any(now)) continue;
        const Wide p = wide_find_end<N>(m, n.g_b, rows, p_c);
        const Wide tx = wide_dot<N>(T::top, 1, n.xi), tz = wide_dot<N>(T::top, 1, n.zeta);
        const Wide ta = wide_dot<N>(T::top, 1, n.g_a), tb = wide_dot<N>(T::top, 1, n.g_b);
        const Wide s2 = tx * tx + tz * tz, g2 = ta * ta + tb * tb;
        const WideMask resolved =
            (7.0 * p * s2 <= 3.0 * tolerance * m.mu_b) &
            (81.0 * (p * p) * (g2 * wide_root(g2)) <= 9.0 * (tolerance * tolerance) * (m.mu_b * m.mu_s));
        const WideMask good = now & resolved;
        out.p = choose(good, p, out.p);
        out.xi = choose(good, p * wide_dot<N>(T::weights, 1, n.xi), out.xi);
        out.zeta = choose(good, p * wide_dot<N>(T::weights, 1, n.zeta), out.zeta);
        out.g_a = choose(good, p * wide_dot<N>(T::weights, 1, n.g_a), out.g_a);
        out.g_b = choose(good, p * wide_dot<N>(T::weights, 1, n.g_b), out.g_b);
        out.sweeps = choose(good, wide(k + 1.0), out.sweeps);
        out.converged |= good;
        open &= ~now;
    }
}

}  // namespace
}  // namespace carom::kernel
