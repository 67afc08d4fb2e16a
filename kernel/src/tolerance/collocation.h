// One Gauss collocation of the impact over one stretch of normal impulse, by Picard sweeps.
//
// Legend (docs/kernel_tolerance.md): everything is per mass and scaled by the approach speed. s = (x, z) slip
// between the balls, z >= 0; u = (a, b) slip of the active ball on the cloth; p normal impulse; v normal
// velocity, -1 at the start; xi = mu_b x/|s|, zeta = mu_b z/|s|, g_a = mu_s zeta a/|u|, g_b = mu_s zeta b/|u|;
//
//     x' = -7 xi + g_a   z' = -5 zeta + 5/2 g_b   a' = xi - kappa g_a   b' = 1 - sigma zeta - kappa g_b   v'
//     = 2 - g_b
//
// with sigma and kappa = 1 - sigma: (-5/2, 7/2) for the consistent sign of the cloth slip, (5/2, -3/2) as published.
#pragma once

#include "frame.h"
#include "simd.h"
#include "tolerance/tables.h"

namespace carom::kernel {
namespace {

// A variable at the 4 K nodes of a stretch.
template <int K>
struct Lanes {
    V4 v[K];
};

template <int K>
struct Tables;

template <>
struct Tables<1> {
    static constexpr const double* nodes = kNodes4;
    static constexpr const double* weights = kWeights4;
    static constexpr const double* integral = kIntegral4[0];
    static constexpr const double* before = kBefore4[0];
    static constexpr const double* before_late = kBeforeLate4[0];
    static constexpr const double* after_late = kAfterLate4[0];
    static constexpr const double* top = kTop4;
    static constexpr int sweeps = 24;
};

template <>
struct Tables<2> {
    static constexpr const double* nodes = kNodes8;
    static constexpr const double* weights = kWeights8;
    static constexpr const double* integral = kIntegral8[0];
    static constexpr const double* before = kBefore8[0];
    static constexpr const double* before_late = kBeforeLate8[0];
    static constexpr const double* after_late = kAfterLate8[0];
    static constexpr const double* top = kTop8;
    static constexpr int sweeps = 24;
};

// Constants of one impact.
struct Model {
    double mu_b, mu_s, sigma, kappa;
    double e_b;
};

struct State {
    double x, z, a, b, v;
};

struct Impulses {
    double p, xi, zeta, g_a, g_b;
};

enum class End : unsigned char {
    kWhole,   // from v = -1 to the end of restitution, with the end of compression somewhere inside
    kFixed,   // a given impulse
    kToZero,  // to the end of compression, v = 0
    kToWork,  // to the end of restitution: a given work from here
};

// What a collocation is asked for, and what it found.
struct Stretch {
    double h;             // impulse: given for kFixed, a first guess otherwise; the one found on return
    double work;          // kToWork: the work to do
    double p_c;           // kWhole: impulse at the end of compression, a first guess and then the one found
    double done;          // the other kinds: work of the normal impulse over the stretch
    double row_goal;      // how exact the rows of the end must be
    double sweep_goal;    // square of the error that the iteration may leave
    double root_goal;     // sixth power of the relative error of a carried root before its last correction
    double s_top, g_top;  // sizes of the highest Legendre coefficients: how well the nodes resolve the forces
    int sweeps;
};

// sum_j table column j * f_j
template <int K>
CAROM_INLINE V4 combine(const double* table, int row, const Lanes<K>& f) {
    const auto column = [&](int j) { return load4(table + 4 * K * j + 4 * row); };
    V4 total = (column(0) * broadcast<0>(f.v[0]) + column(1) * broadcast<1>(f.v[0])) +
               (column(2) * broadcast<2>(f.v[0]) + column(3) * broadcast<3>(f.v[0]));
    if constexpr (K == 2) {
        total += (column(4) * broadcast<0>(f.v[1]) + column(5) * broadcast<1>(f.v[1])) +
                 (column(6) * broadcast<2>(f.v[1]) + column(7) * broadcast<3>(f.v[1]));
    }
    return total;
}

template <int K>
CAROM_INLINE double dot(const double* weights, const Lanes<K>& f) {
    V4 total = load4(weights) * f.v[0];
    if constexpr (K == 2) total += load4(weights + 4) * f.v[1];
    return sum(total);
}

// Error of the rows, as a share of the tolerance, from which on they are set anew.
constexpr double kRowsGoal = 0.1;

// Rows that integrate a force over compression and restitution, for an end of compression at t_c = 2 p_c/p
// - 1.
template <int K>
struct EndRows {
    double t;  // the t_c that they are made for
    Lanes<K> before, before_late, after_late;
};

template <int K>
CAROM_INLINE Lanes<K> row_at(const double* table, double t) {
    Lanes<K> row;
    const V4 T = all(t);
    for (int k = 0; k < K; ++k) {
        const auto coefficient = [&](int power) { return load4(table + 4 * K * power + 4 * k); };
        const V4 T2 = T * T;
        V4 value = (coefficient(0) + coefficient(1) * T) + (coefficient(2) + coefficient(3) * T) * T2;
        if constexpr (K == 2) {
            value += ((coefficient(4) + coefficient(5) * T) + (coefficient(6) + coefficient(7) * T) * T2) *
                     (T2 * T2);
        }
        row.v[k] = value;
    }
    return row;
}

template <int K>
CAROM_INLINE void set_rows(double t, EndRows<K>& rows) {
    rows.t = t;
    rows.before = row_at<K>(Tables<K>::before, t);
    rows.before_late = row_at<K>(Tables<K>::before_late, t);
    rows.after_late = row_at<K>(Tables<K>::after_late, t);
}

template <int K>
CAROM_INLINE double dot(const Lanes<K>& weights, const Lanes<K>& f) {
    V4 total = weights.v[0] * f.v[0];
    if constexpr (K == 2) total += weights.v[1] * f.v[1];
    return sum(total);
}

// Int_0^1 (1 - tau) f dtau
template <int K>
CAROM_INLINE double late_share(const Lanes<K>& f) {
    Lanes<K> late;
    for (int k = 0; k < K; ++k) late.v[k] = (all(1.0) - load4(Tables<K>::nodes + 4 * k)) * f.v[k];
    return dot<K>(Tables<K>::weights, late);
}

// The impulse at which the stretch ends, from the cloth force at its nodes. Compression ends where v = 0,
// restitution where the work of the normal impulse is e_b^2 times that of compression; both by quadrature of g_b.
template <int K, End kEnd>
CAROM_INLINE void find_end(const Model& m, const State& start, const Lanes<K>& g_b, const EndRows<K>& rows,
                           Stretch& stretch) {
    using T = Tables<K>;
    if constexpr (kEnd == End::kWhole) {
        const double p_c = 1.0 / (2.0 - dot<K>(rows.before, g_b));
        const double gain = 1.0 / (1.0 - dot<K>(rows.after_late, g_b));
        const double work = p_c * (1.0 - p_c * (1.0 - dot<K>(rows.before_late, g_b)));
        stretch.p_c = p_c;
        stretch.h = p_c + m.e_b * square_root(work * gain);
    } else if constexpr (kEnd == End::kToZero) {
        stretch.h = -start.v / (2.0 - dot<K>(T::weights, g_b));
    } else if constexpr (kEnd == End::kToWork) {
        const double lost = 1.0 - late_share<K>(g_b);
        stretch.h =
            2.0 * stretch.work / (start.v + square_root(start.v * start.v + 4.0 * lost * stretch.work));
    }
}

template <int K>
struct Nodes {
    Lanes<K> x, z, a, b;          // the slips
    Lanes<K> root_s, root_u;      // 1/|s|, 1/|u|
    Lanes<K> xi, zeta, g_a, g_b;  // the forces
};

// Forces at the nodes. `exact`: fresh reciprocal roots;
// otherwise the old ones are corrected by one cubic Newton step.
template <int K, bool kExact>
CAROM_INLINE V4 forces(const Model& m, Nodes<K>& n) {
    V4 worst = all(0.0);
    for (int k = 0; k < K; ++k) {
        const V4 ss = n.x.v[k] * n.x.v[k] + n.z.v[k] * n.z.v[k],
                 uu = n.a.v[k] * n.a.v[k] + n.b.v[k] * n.b.v[k];
        if constexpr (kExact) {
            n.root_s.v[k] = all(1.0) / square_root(ss);
            n.root_u.v[k] = all(1.0) / square_root(uu);
        } else {
            const V4 rs = all(1.0) - ss * (n.root_s.v[k] * n.root_s.v[k]);
            const V4 ru = all(1.0) - uu * (n.root_u.v[k] * n.root_u.v[k]);
            n.root_s.v[k] += n.root_s.v[k] * (rs * (all(0.5) + all(0.375) * rs));
            n.root_u.v[k] += n.root_u.v[k] * (ru * (all(0.5) + all(0.375) * ru));
            worst += rs * rs + ru * ru;
        }
        n.xi.v[k] = (all(m.mu_b) * n.root_s.v[k]) * n.x.v[k];
        n.zeta.v[k] = (all(m.mu_b) * n.root_s.v[k]) * n.z.v[k];
        const V4 t = (all(m.mu_s) * n.root_u.v[k]) * n.zeta.v[k];
        n.g_a.v[k] = t * n.a.v[k];
        n.g_b.v[k] = t * n.b.v[k];
    }
    return worst;
}

// The slips at the nodes from the forces there. Returns the squares of their changes, as shares of |s| and,
// weighted by what it can do, of |u|.
template <int K>
CAROM_INLINE V4 slips(const Model& m, const State& start, double h, Nodes<K>& n) {
    V4 change = all(0.0);
    const V4 H = all(h);
    Lanes<K> dx, dz, da, db;
    for (int k = 0; k < K; ++k) {
        dx.v[k] = n.g_a.v[k] - all(7.0) * n.xi.v[k];
        dz.v[k] = all(2.5) * n.g_b.v[k] - all(5.0) * n.zeta.v[k];
        da.v[k] = n.xi.v[k] - all(m.kappa) * n.g_a.v[k];
        db.v[k] = all(1.0) - (all(m.sigma) * n.zeta.v[k] + all(m.kappa) * n.g_b.v[k]);
    }
    for (int k = 0; k < K; ++k) {
        const V4 x = all(start.x) + H * combine<K>(Tables<K>::integral, k, dx);
        const V4 z = all(start.z) + H * combine<K>(Tables<K>::integral, k, dz);
        const V4 a = all(start.a) + H * combine<K>(Tables<K>::integral, k, da);
        const V4 b = all(start.b) + H * combine<K>(Tables<K>::integral, k, db);
        const V4 ex = (x - n.x.v[k]) * n.root_s.v[k], ez = (z - n.z.v[k]) * n.root_s.v[k];
        const V4 ea = (a - n.a.v[k]) * n.root_u.v[k], eb = (b - n.b.v[k]) * n.root_u.v[k];
        change += (ex * ex + ez * ez) + all(m.mu_s * m.mu_s) * (ea * ea + eb * eb);
        n.x.v[k] = x;
        n.z.v[k] = z;
        n.a.v[k] = a;
        n.b.v[k] = b;
    }
    return change;
}

// The impulses of a stretch change the state.
CAROM_INLINE void add_stretch(const Model& m, const Impulses& t, State& state, Impulses& total) {
    state.x += t.g_a - 7.0 * t.xi;
    state.z += 2.5 * t.g_b - 5.0 * t.zeta;
    state.a += t.xi - m.kappa * t.g_a;
    state.b += t.p - (m.sigma * t.zeta + m.kappa * t.g_b);
    state.v += 2.0 * t.p - t.g_b;
    total.p += t.p;
    total.xi += t.xi;
    total.zeta += t.zeta;
    total.g_a += t.g_a;
    total.g_b += t.g_b;
}

// Solves one stretch. False if the sweeps do not converge; then nothing has changed but `stretch.h`. The
// roots of the first `exact` sweeps are fresh, those of later ones carried; `root_s` is 1/|s| at the start.
template <int K, End kEnd>
CAROM_INLINE bool collocate(const Model& m, State& state, Impulses& total, Stretch& stretch, double root_s,
                            int exact) {
    using T = Tables<K>;
    const State start = state;
    Nodes<K> n;
    // First guess: the forces of the start, with the cloth slip carried along by the normal impulse alone.
    const double share = m.mu_b * root_s;
    const double xi0 = share * start.x, zeta0 = share * start.z;
    for (int k = 0; k < K; ++k) {
        const V4 p = all(stretch.h) * load4(T::nodes + 4 * k);
        n.x.v[k] = all(start.x) - p * all(7.0 * xi0);
        n.z.v[k] = all(start.z) - p * all(5.0 * zeta0);
        n.a.v[k] = all(start.a) + p * all(xi0);
        n.b.v[k] = all(start.b) + p * all(1.0 - m.sigma * zeta0);
    }
    forces<K, true>(m, n);
    const double reach = 7.0 * m.mu_b * stretch.h;
    // A change of the slips leaves an error of contraction * change
    // behind the next forces, and those act over `reach`.
    V4 tight = n.root_s.v[0] * n.root_s.v[0] + all(m.mu_s * m.mu_s) * (n.root_u.v[0] * n.root_u.v[0]);
    if constexpr (K == 2) {
        tight += n.root_s.v[1] * n.root_s.v[1] + all(m.mu_s * m.mu_s) * (n.root_u.v[1] * n.root_u.v[1]);
    }
    const double steep = sum(tight),
                 slope = (reach * reach) * (reach * reach) * (steep * (1.0 / (16.0 * K * K)));
    const double end_slope = 40.0 * ((m.mu_b * m.mu_b) * (m.mu_s * m.mu_s));
    bool converged = false;
    double dh_before = 0.0, t_c = 2.0 / (1.0 + m.e_b) - 1.0;
    EndRows<K> rows;
    if constexpr (kEnd == End::kWhole) set_rows<K>(t_c, rows);
    int k = 1;
    for (; k < T::sweeps && !converged; ++k) {
        const double h = stretch.h;
        const V4 change = slips<K>(m, start, h, n);
        find_end<K, kEnd>(m, start, n.g_b, rows, stretch);
        // The rows follow the end of compression with a delay of one sweep, so that no sweep waits for them.
        if constexpr (kEnd == End::kWhole) {
            if (absolute(t_c - rows.t) * m.mu_b * m.mu_s > stretch.row_goal) set_rows<K>(t_c, rows);
            t_c = 2.0 * stretch.p_c / stretch.h - 1.0;
        }
        const V4 root = k < exact ? forces<K, true>(m, n) : forces<K, false>(m, n);
        const double dh = stretch.h - h;
        // The end, too, is a fixed point, with a contraction of at most a few mu_s mu_b.
        const double r = sum(root);
        // Many sweeps mean a contraction near 1, behind which more is left than the last change shows.
        const double slow = 1.0 + 0.03125 * (k * k);
        converged =
            ((sum(change) + dh * dh * steep) * slope + (dh * dh + dh_before * dh_before) * end_slope) *
                    slow <=
                stretch.sweep_goal &&
            r * r * r <= stretch.root_goal;
        dh_before = dh;
    }
    stretch.sweeps += k;
    if (!converged) return false;
    find_end<K, kEnd>(m, start, n.g_b, rows, stretch);
    const double h = stretch.h;
    const double xi = h * dot<K>(T::weights, n.xi), zeta = h * dot<K>(T::weights, n.zeta);
    const double g_a = h * dot<K>(T::weights, n.g_a), g_b = h * dot<K>(T::weights, n.g_b);
    const double tx = dot<K>(T::top, n.xi), tz = dot<K>(T::top, n.zeta), ta = dot<K>(T::top, n.g_a),
                 tb = dot<K>(T::top, n.g_b);
    stretch.s_top = square_root(tx * tx + tz * tz);
    stretch.g_top = square_root(ta * ta + tb * tb);
    if constexpr (kEnd != End::kWhole) stretch.done = start.v * h + h * h * (1.0 - late_share<K>(n.g_b));
    add_stretch(m, {h, xi, zeta, g_a, g_b}, state, total);
    return true;
}

}  // namespace
}  // namespace carom::kernel
