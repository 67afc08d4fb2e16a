// One collocation of many impacts: each lane is an impact, and the nodes are elements of arrays. Symbols:
// collocation.h.
//
// A lane reads only its own numbers, and stores the impulses of the sweep at which it converged. Its bits
// therefore depend neither on the register width nor on the impacts in the other lanes.
#pragma once

#include "gauss.h"
#include "tolerance/collocation.h"

namespace carom::kernel {
namespace {

// A pack of impacts: one register, or two if registers hold two doubles.
constexpr int kWidth = kRegisterLanes < 4 ? 4 : kRegisterLanes;
using Wide = Pack<kWidth>;
using WideMask = Mask<kWidth>;

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

// sum_j row[j] f[j], even and odd terms separately
template <int N>
CAROM_INLINE Wide wide_dot(const double* row, int stride, const Wide (&f)[N]) {
    Wide even = row[0] * f[0], odd = row[stride] * f[1];
    for (int j = 2; j < N; j += 2) {
        even += row[j * stride] * f[j];
        odd += row[(j + 1) * stride] * f[j + 1];
    }
    return even + odd;
}

// Integrals from 0 to every node, for the even and the odd part of f: half the sum and half the difference of
// mirrored columns. The nodes are symmetric, so each part needs only half a table.
struct Mirrored8 {
    double even[4][4], odd[4][4];
    constexpr Mirrored8() : even{}, odd{} {
        for (int i = 0; i < 4; ++i) {
            for (int j = 0; j < 4; ++j) {
                even[i][j] = 0.5 * (Gauss<8>::integral[j][i] + Gauss<8>::integral[7 - j][i]);
                odd[i][j] = 0.5 * (Gauss<8>::integral[j][i] - Gauss<8>::integral[7 - j][i]);
            }
        }
    }
};
constexpr Mirrored8 kMirrored8;

// integral[i] = start + h times the integral of f from 0 to node i
template <int N>
CAROM_INLINE void wide_integrals(Wide start, Wide h, const Wide (&f)[N], Wide (&integral)[N]) {
    if constexpr (N == 4) {
        for (int i = 0; i < N; ++i) integral[i] = start + h * wide_dot<N>(Gauss<N>::integral[0] + i, N, f);
    } else {
        constexpr int H = N / 2;
        Wide sums[H], differences[H];
        for (int j = 0; j < H; ++j) {
            sums[j] = f[j] + f[N - 1 - j];
            differences[j] = f[j] - f[N - 1 - j];
        }
        const Wide total = wide_dot<H>(Gauss<N>::weights, 1, sums);
        for (int i = 0; i < H; ++i) {
            const Wide even = wide_dot<H>(kMirrored8.even[i], 1, sums);
            const Wide odd = wide_dot<H>(kMirrored8.odd[i], 1, differences);
            integral[i] = start + h * (odd + even);
            integral[N - 1 - i] = start + h * (odd + (total - even));
        }
    }
}

enum class Roots : unsigned char { kFresh, kCarried, kMixed };

// As forces(). The reciprocal roots are computed afresh (kFresh), or those of the previous sweep are
// corrected (kCarried); kMixed: afresh in the lanes of `exact`.
template <int N, Roots kRoots>
CAROM_INLINE Wide wide_forces(const WideModel& m, WideNodes<N>& n, WideMask exact = WideMask{}) {
    Wide worst = {};
    for (int i = 0; i < N; ++i) {
        const Wide ss = n.x[i] * n.x[i] + n.z[i] * n.z[i], uu = n.a[i] * n.a[i] + n.b[i] * n.b[i];
        Wide fresh_s, fresh_u;
        if constexpr (kRoots != Roots::kCarried) {
            // One division for both roots.
            const Wide s = square_root(ss), u = square_root(uu), share = 1.0 / (s * u);
            fresh_s = share * u;
            fresh_u = share * s;
        }
        if constexpr (kRoots == Roots::kFresh) {
            n.root_s[i] = fresh_s;
            n.root_u[i] = fresh_u;
        } else {
            // Newton's step: fewer operations than the cubic one of forces(), and equally many sweeps. A very
            // wrong root can lead to the negative root, so callers must check the returned value.
            const Wide rs = 1.0 - ss * (n.root_s[i] * n.root_s[i]),
                       ru = 1.0 - uu * (n.root_u[i] * n.root_u[i]);
            n.root_s[i] += n.root_s[i] * (0.5 * rs);
            n.root_u[i] += n.root_u[i] * (0.5 * ru);
            Wide left = rs * rs + ru * ru;
            if constexpr (kRoots == Roots::kMixed) {
                n.root_s[i] = select(exact, fresh_s, n.root_s[i]);
                n.root_u[i] = select(exact, fresh_u, n.root_u[i]);
                left = select(exact, Wide{}, left);
            }
            worst += left;
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

// The rates of the slips.
template <int N>
CAROM_INLINE void wide_rates(const WideModel& m, const WideNodes<N>& n, Wide (&dx)[N], Wide (&dz)[N],
                             Wide (&da)[N], Wide (&db)[N]) {
    for (int i = 0; i < N; ++i) {
        dx[i] = n.g_a[i] - 7.0 * n.xi[i];
        dz[i] = 2.5 * n.g_b[i] - 5.0 * n.zeta[i];
        da[i] = n.xi[i] - m.kappa * n.g_a[i];
        db[i] = 1.0 - (m.sigma * n.zeta[i] + m.kappa * n.g_b[i]);
    }
}

// As slips().
template <int N>
CAROM_INLINE Wide wide_slips(const WideModel& m, const WideStart& start, Wide h, WideNodes<N>& n) {
    Wide dx[N], dz[N], da[N], db[N], change = {};
    wide_rates<N>(m, n, dx, dz, da, db);
    Wide nx[N], nz[N], na[N], nb[N];
    wide_integrals<N>(start.x, h, dx, nx);
    wide_integrals<N>(start.z, h, dz, nz);
    wide_integrals<N>(start.a, h, da, na);
    wide_integrals<N>(start.b, h, db, nb);
    const Wide mu2 = m.mu_s * m.mu_s;
    for (int i = 0; i < N; ++i) {
        const Wide x = nx[i], z = nz[i], a = na[i], b = nb[i];
        if (i % 2 == 1) {
            const Wide ex = x - n.x[i], ez = z - n.z[i], ea = a - n.a[i], eb = b - n.b[i];
            change += (ex * ex + ez * ez) * (n.root_s[i] * n.root_s[i]) +
                      mu2 * ((ea * ea + eb * eb) * (n.root_u[i] * n.root_u[i]));
        }
        n.x[i] = x;
        n.z[i] = z;
        n.a[i] = a;
        n.b[i] = b;
    }
    return 2.0 * change;
}

// As guess(). kWhole: also guesses the end of a whole impact.
template <int N, bool kWhole>
CAROM_INLINE void wide_guess(const WideModel& m, const WideStart& start, Wide root_s, Wide& h,
                             WideNodes<N>& n) {
    const Wide e_x = root_s * start.x, e_z = root_s * start.z, xi = m.mu_b * e_x, zeta = m.mu_b * e_z;
    const Wide half = start.b + 0.5 * h;
    const Wide by_u = m.mu_s / square_root((start.a * start.a + half * half) + 0.01);
    const Wide g_a = (by_u * start.a) * zeta, g_b = (by_u * half) * zeta;
    const Wide x = g_a - 7.0 * xi, z = 2.5 * g_b - 5.0 * zeta;
    const Wide turn = (e_x * z - e_z * x) * (0.5 * root_s);
    const Wide x2 = 7.0 * (turn * zeta), z2 = -5.0 * (turn * xi);
    const Wide a = xi - m.kappa * g_a, b = 1.0 - (m.sigma * zeta + m.kappa * g_b);
    if constexpr (kWhole) h += (0.5 * h) * g_b;
    for (int i = 0; i < N; ++i) {
        const Wide p = h * Gauss<N>::nodes[i];
        n.x[i] = start.x + p * (x + p * x2);
        n.z[i] = start.z + p * (z + p * z2);
        n.a[i] = start.a + p * a;
        n.b[i] = start.b + p * b;
    }
}

// As slips() from the forces at 4 nodes to 8.
CAROM_INLINE void wide_refine(const WideModel& m, const WideStart& start, Wide h, const WideNodes<4>& coarse,
                              WideNodes<8>& n) {
    Wide dx[4], dz[4], da[4], db[4];
    wide_rates<4>(m, coarse, dx, dz, da, db);
    for (int i = 0; i < 8; ++i) {
        const double* row = Finer::integral[0] + i;
        n.x[i] = start.x + h * wide_dot<4>(row, 8, dx);
        n.z[i] = start.z + h * wide_dot<4>(row, 8, dz);
        n.a[i] = start.a + h * wide_dot<4>(row, 8, da);
        n.b[i] = start.b + h * wide_dot<4>(row, 8, db);
    }
}

// Sweeps made by wide_begin().
template <int N>
constexpr int kBefore = N == 8 ? kCoarseSweeps : 0;

// As begin(). `end` finds the end from g_b at 4 nodes. A wrong root here spoils only the guess.
template <int N, bool kWhole, class End4>
CAROM_INLINE void wide_begin(const WideModel& m, const WideStart& start, Wide root_s, Wide& h,
                             WideNodes<N>& n, End4 end) {
    if constexpr (N == 4) {
        wide_guess<4, kWhole>(m, start, root_s, h, n);
    } else {
        WideNodes<4> coarse;
        wide_guess<4, kWhole>(m, start, root_s, h, coarse);
        wide_forces<4, Roots::kFresh>(m, coarse);
        for (int k = 0; k < kCoarseSweeps; ++k) {
            wide_slips<4>(m, start, h, coarse);
            h = end(coarse.g_b);
            wide_forces<4, Roots::kCarried>(m, coarse);
        }
        wide_refine(m, start, h, coarse, n);
        if constexpr (kWhole) h = end(coarse.g_b);
    }
    wide_forces<N, Roots::kFresh>(m, n);
}

// As EndRows.
template <int N>
struct WideRows {
    Wide t, before[N], before_late[N], after_late[N];
};

template <int N>
CAROM_INLINE Wide wide_polynomial(const double* table, Wide t) {
    Wide value = broadcast<kWidth>(table[(N - 1) * N]);
    for (int k = N - 2; k >= 0; --k) value = value * t + table[k * N];
    return value;
}

template <int N>
CAROM_INLINE void wide_set_rows(Wide t, WideRows<N>& rows) {
    rows.t = t;
    for (int j = 0; j < N; ++j) {
        rows.before[j] = wide_polynomial<N>(Gauss<N>::before[0] + j, t);
        rows.before_late[j] = wide_polynomial<N>(Gauss<N>::before_late[0] + j, t);
        rows.after_late[j] = wide_polynomial<N>(Gauss<N>::after_late[0] + j, t);
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

// As find_end() of a whole impact.
template <int N>
CAROM_INLINE Wide wide_find_end(const WideModel& m, const Wide (&g_b)[N], const WideRows<N>& rows,
                                Wide& p_c) {
    const Wide share = 2.0 - wide_dot<N>(rows.before, g_b), lost = 1.0 - wide_dot<N>(rows.after_late, g_b);
    const Wide late = wide_dot<N>(rows.before_late, g_b), both = 1.0 / (lost * share);
    p_c = both * lost;
    return both * (lost + m.e_b * square_root(lost * (share - (1.0 - late))));
}

// The forces of the sweep at which a lane converged.
template <int N>
struct WideForces {
    Wide xi[N], zeta[N], g_a[N], g_b[N];
};

template <int N>
CAROM_INLINE void wide_keep(WideMask lanes, const WideNodes<N>& n, WideForces<N>& kept) {
    if (!any(lanes)) return;
    for (int i = 0; i < N; ++i) {
        kept.xi[i] = select(lanes, n.xi[i], kept.xi[i]);
        kept.zeta[i] = select(lanes, n.zeta[i], kept.zeta[i]);
        kept.g_a[i] = select(lanes, n.g_a[i], kept.g_a[i]);
        kept.g_b[i] = select(lanes, n.g_b[i], kept.g_b[i]);
    }
}

// As resolved().
template <int N>
CAROM_INLINE WideMask wide_resolved(const WideModel& m, Wide p, double tolerance, const WideForces<N>& f) {
    using G = Gauss<N>;
    const Wide tx = wide_dot<N>(G::top, 1, f.xi), tz = wide_dot<N>(G::top, 1, f.zeta);
    const Wide ta = wide_dot<N>(G::top, 1, f.g_a), tb = wide_dot<N>(G::top, 1, f.g_b);
    return resolved(m.mu_b, m.mu_s, p, tx * tx + tz * tz, ta * ta + tb * tb, tolerance);
}

template <int N>
CAROM_INLINE void wide_integrate(Wide p, const WideForces<N>& f, WideResult& out) {
    using G = Gauss<N>;
    out.p = p;
    out.xi = p * wide_dot<N>(G::weights, 1, f.xi);
    out.zeta = p * wide_dot<N>(G::weights, 1, f.zeta);
    out.g_a = p * wide_dot<N>(G::weights, 1, f.g_a);
    out.g_b = p * wide_dot<N>(G::weights, 1, f.g_b);
}

// As Goals, for the corrections of wide_forces().
struct WideGoals {
    Wide sweep, root;
};

CAROM_INLINE WideGoals wide_goals(const WideModel& m, double tolerance) {
    const Wide share = kShareOfFriction * m.mu_b;
    const Wide left = select(share < tolerance, share, broadcast<kWidth>(tolerance)), left2 = left * left;
    // A correction leaves 3/8 r^2 of r = 1 - |.|^2 T^2, and an error of a direction acts with 7 mu_b.
    return {kSweepGoalOfLanes * left2, (0.035 * left2) / (m.mu_b * m.mu_b)};
}

// As collocate() of a whole impact, for the lanes `wanted`; `out.converged` excludes lanes that do not
// converge.
template <int N>
CAROM_INLINE void wide_collocate(const WideModel& m, const WideStart& start, WideMask wanted, Wide root_s,
                                 double tolerance, WideResult& out) {
    WideNodes<N> n;
    Wide h = 0.5 * (1.0 + m.e_b), t_c = 2.0 / (1.0 + m.e_b) - 1.0;
    WideRows<4> coarse_rows;
    Wide p_c;
    if constexpr (N == 8) wide_set_rows<4>(t_c, coarse_rows);
    wide_begin<N, true>(m, start, root_s, h, n,
                        [&](const Wide(&g_b)[4]) { return wide_find_end<4>(m, g_b, coarse_rows, p_c); });
    if constexpr (N == 8) t_c = 2.0 * p_c / h - 1.0;
    WideRows<N> rows;
    wide_set_rows<N>(t_c, rows);
    const Wide mu2 = m.mu_s * m.mu_s, reach2 = (7.0 * m.mu_b * h) * (7.0 * m.mu_b * h);
    Wide steep = {};
    for (int i = 0; i < N; ++i) steep += n.root_s[i] * n.root_s[i] + mu2 * (n.root_u[i] * n.root_u[i]);
    const Wide slope = (reach2 * reach2) * (steep * (1.0 / (N * N))),
               end_slope = steep * slope + 40.0 * ((m.mu_b * m.mu_b) * mu2);
    const WideGoals goal = wide_goals(m, tolerance);
    WideMask open = wanted, finished = {};
    WideForces<N> kept = {};
    for (int k = 1; k < kMostSweeps && any(open); ++k) {
        const Wide change = wide_slips<N>(m, start, h, n);
        const Wide h_new = wide_find_end<N>(m, n.g_b, rows, p_c), dh = h_new - h;
        // The rows change only in the lanes that need it, so that each lane is independent of the others.
        const WideMask moved = open & (absolute(t_c - rows.t) * m.mu_b * m.mu_s > kRowsGoal * tolerance);
        if (any(moved)) wide_set_rows<N>(select(moved, t_c, rows.t), rows);
        t_c = 2.0 * p_c / h_new - 1.0;
        h = h_new;
        const Wide r = wide_forces<N, Roots::kCarried>(m, n);
        const Wide left = slope * change + end_slope * (dh * dh);
        const double slow = 1.0 + 0.03125 * (k * k);
        const WideMask now = open & (left * slow <= goal.sweep) & (r * r <= goal.root);
        wide_keep<N>(now, n, kept);
        finished |= now;
        out.sweeps = select(now, broadcast<kWidth>(k + 1.0 + kBefore<N>), out.sweeps);
        open &= ~now & (r < 1.0);  // a very wrong root may have become negative
    }
    // A lane's rows do not change after it has converged.
    const Wide p = wide_find_end<N>(m, kept.g_b, rows, p_c);
    out.converged = finished & wide_resolved<N>(m, p, tolerance, kept);
    wide_integrate<N>(p, kept, out);
}

}  // namespace
}  // namespace carom::kernel
