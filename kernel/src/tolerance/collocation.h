// Gauss collocation of the impact over one stretch of the normal impulse, solved by Picard sweeps.
//
// All quantities are per unit mass and scaled by the approach speed (docs/design/impact_kernel.md). s = (x, z) is the
// slip between the balls, z >= 0; u = (a, b) is the slip of the active ball, which is pressed on the cloth; p is the
// normal impulse; v is the normal velocity, -1 at the start. The forces are
//
//     xi = mu_b x/|s|   zeta = mu_b z/|s|   g_a = mu_s zeta a/|u|   g_b = mu_s zeta b/|u|
//
// and the equations of motion, with ' = d/dp,
//
//     x' = -7 xi + g_a   z' = -5 zeta + 5/2 g_b   a' = xi - kappa g_a   b' = 1 - sigma zeta - kappa g_b   v' = 2 - g_b
//
// with (sigma, kappa = 1 - sigma) = (-5/2, 7/2) for the consistent sign of the cloth slip, (5/2, -3/2) as published.
#pragma once

#include "frame.h"
#include "simd.h"
#include "tolerance/gauss.h"

namespace carom::kernel {
namespace {

// Most Picard sweeps of one collocation. One that converges more slowly than this is solved in shorter stretches.
constexpr int kMostSweeps = 24;

// The error of the rows (EndRows) from which on they are computed anew, as a share of the tolerance.
constexpr double kRowsGoal = 0.1;

// A variable at the N nodes of a stretch.
template <int N>
struct Lanes {
    Pack<4> v[N / 4];
};

// The constants of one impact.
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

// Where a stretch ends.
enum class End : unsigned char {
    kWhole,   // at the end of restitution, from v = -1; the end of compression lies inside
    kFixed,   // after a given impulse
    kToZero,  // at the end of compression, v = 0
    kToWork,  // at the end of restitution, after a given work
};

// What a collocation is asked for, and what it found.
struct Stretch {
    double h;           // impulse: given for kFixed, otherwise a first guess and then the result
    double work;        // kToWork: the work to do
    double p_c;         // kWhole: impulse at the end of compression, a first guess and then the result
    double done;        // all kinds but kWhole: work of the normal impulse over the stretch
    double row_goal;    // largest error of the rows of the end
    double sweep_goal;  // square of the largest error that the iteration may leave
    double
        root_goal;  // sixth power of the largest relative error of a carried root before its last correction
    double s_top;   // size of the highest Legendre coefficient of (xi, zeta): how well the nodes resolve them
    double g_top;   // the same of (g_a, g_b)
    int sweeps;
};

// The sum over j of column j of the table times f_j.
template <int N>
CAROM_INLINE Pack<4> combine(const double* table, int row, const Lanes<N>& f) {
    const auto column = [&](int j) { return load<4>(table + N * j + 4 * row); };
    Pack<4> total = (column(0) * broadcast_lane<0>(f.v[0]) + column(1) * broadcast_lane<1>(f.v[0])) +
                    (column(2) * broadcast_lane<2>(f.v[0]) + column(3) * broadcast_lane<3>(f.v[0]));
    if constexpr (N == 8) {
        total += (column(4) * broadcast_lane<0>(f.v[1]) + column(5) * broadcast_lane<1>(f.v[1])) +
                 (column(6) * broadcast_lane<2>(f.v[1]) + column(7) * broadcast_lane<3>(f.v[1]));
    }
    return total;
}

template <int N>
CAROM_INLINE double dot(const double* weights, const Lanes<N>& f) {
    Pack<4> total = load<4>(weights) * f.v[0];
    if constexpr (N == 8) total += load<4>(weights + 4) * f.v[1];
    return sum(total);
}

// Rows that integrate a force over compression and over restitution, for an end of compression at t_c = 2 p_c/p - 1.
template <int N>
struct EndRows {
    double t;  // the t_c of these rows
    Lanes<N> before, before_late, after_late;
};

template <int N>
CAROM_INLINE Lanes<N> row_at(const double* table, double t) {
    Lanes<N> row;
    const Pack<4> T = broadcast<4>(t);
    for (int k = 0; k < N / 4; ++k) {
        const auto coefficient = [&](int power) { return load<4>(table + N * power + 4 * k); };
        const Pack<4> T2 = T * T;
        Pack<4> value = (coefficient(0) + coefficient(1) * T) + (coefficient(2) + coefficient(3) * T) * T2;
        if constexpr (N == 8) {
            value += ((coefficient(4) + coefficient(5) * T) + (coefficient(6) + coefficient(7) * T) * T2) *
                     (T2 * T2);
        }
        row.v[k] = value;
    }
    return row;
}

template <int N>
CAROM_INLINE void set_rows(double t, EndRows<N>& rows) {
    rows.t = t;
    rows.before = row_at<N>(Gauss<N>::before[0], t);
    rows.before_late = row_at<N>(Gauss<N>::before_late[0], t);
    rows.after_late = row_at<N>(Gauss<N>::after_late[0], t);
}

template <int N>
CAROM_INLINE double dot(const Lanes<N>& weights, const Lanes<N>& f) {
    Pack<4> total = weights.v[0] * f.v[0];
    if constexpr (N == 8) total += weights.v[1] * f.v[1];
    return sum(total);
}

// Int_0^1 (1 - tau) f dtau
template <int N>
CAROM_INLINE double late_share(const Lanes<N>& f) {
    Lanes<N> late;
    for (int k = 0; k < N / 4; ++k) late.v[k] = (1.0 - load<4>(Gauss<N>::nodes + 4 * k)) * f.v[k];
    return dot<N>(Gauss<N>::weights, late);
}

// The impulse at which the stretch ends, by quadrature of the cloth force g_b. Compression ends where v = 0,
// restitution where the work of the normal impulse is e_b^2 times that of compression.
template <int N, End kEnd>
CAROM_INLINE void find_end(const Model& m, const State& start, const Lanes<N>& g_b, const EndRows<N>& rows,
                           Stretch& stretch) {
    using G = Gauss<N>;
    if constexpr (kEnd == End::kWhole) {
        const double p_c = 1.0 / (2.0 - dot<N>(rows.before, g_b));
        const double gain = 1.0 / (1.0 - dot<N>(rows.after_late, g_b));
        const double work = p_c * (1.0 - p_c * (1.0 - dot<N>(rows.before_late, g_b)));
        stretch.p_c = p_c;
        stretch.h = p_c + m.e_b * square_root(work * gain);
    } else if constexpr (kEnd == End::kToZero) {
        stretch.h = -start.v / (2.0 - dot<N>(G::weights, g_b));
    } else if constexpr (kEnd == End::kToWork) {
        const double lost = 1.0 - late_share<N>(g_b);
        stretch.h =
            2.0 * stretch.work / (start.v + square_root(start.v * start.v + 4.0 * lost * stretch.work));
    }
}

template <int N>
struct Nodes {
    Lanes<N> x, z, a, b;          // the slips
    Lanes<N> root_s, root_u;      // 1/|s|, 1/|u|
    Lanes<N> xi, zeta, g_a, g_b;  // the forces
};

// Forces at the nodes. The reciprocal roots are computed afresh (kExact), or those of the sweep before are corrected
// by one cubic Newton step. Returns the squares of their relative errors before the correction.
template <int N, bool kExact>
CAROM_INLINE Pack<4> forces(const Model& m, Nodes<N>& n) {
    Pack<4> worst{};
    for (int k = 0; k < N / 4; ++k) {
        const Pack<4> ss = n.x.v[k] * n.x.v[k] + n.z.v[k] * n.z.v[k],
                      uu = n.a.v[k] * n.a.v[k] + n.b.v[k] * n.b.v[k];
        if constexpr (kExact) {
            n.root_s.v[k] = 1.0 / square_root(ss);
            n.root_u.v[k] = 1.0 / square_root(uu);
        } else {
            const Pack<4> rs = 1.0 - ss * (n.root_s.v[k] * n.root_s.v[k]);
            const Pack<4> ru = 1.0 - uu * (n.root_u.v[k] * n.root_u.v[k]);
            n.root_s.v[k] += n.root_s.v[k] * (rs * (0.5 + 0.375 * rs));
            n.root_u.v[k] += n.root_u.v[k] * (ru * (0.5 + 0.375 * ru));
            worst += rs * rs + ru * ru;
        }
        n.xi.v[k] = (m.mu_b * n.root_s.v[k]) * n.x.v[k];
        n.zeta.v[k] = (m.mu_b * n.root_s.v[k]) * n.z.v[k];
        const Pack<4> t = (m.mu_s * n.root_u.v[k]) * n.zeta.v[k];
        n.g_a.v[k] = t * n.a.v[k];
        n.g_b.v[k] = t * n.b.v[k];
    }
    return worst;
}

// The slips at the nodes from the forces there. Returns the squares of their changes as shares of |s| and of |u|, the
// latter weighted by the largest effect that it can have.
template <int N>
CAROM_INLINE Pack<4> slips(const Model& m, const State& start, double h, Nodes<N>& n) {
    Pack<4> change{};
    Lanes<N> dx, dz, da, db;
    for (int k = 0; k < N / 4; ++k) {
        dx.v[k] = n.g_a.v[k] - 7.0 * n.xi.v[k];
        dz.v[k] = 2.5 * n.g_b.v[k] - 5.0 * n.zeta.v[k];
        da.v[k] = n.xi.v[k] - m.kappa * n.g_a.v[k];
        db.v[k] = 1.0 - (m.sigma * n.zeta.v[k] + m.kappa * n.g_b.v[k]);
    }
    for (int k = 0; k < N / 4; ++k) {
        const Pack<4> x = start.x + h * combine<N>(Gauss<N>::integral[0], k, dx);
        const Pack<4> z = start.z + h * combine<N>(Gauss<N>::integral[0], k, dz);
        const Pack<4> a = start.a + h * combine<N>(Gauss<N>::integral[0], k, da);
        const Pack<4> b = start.b + h * combine<N>(Gauss<N>::integral[0], k, db);
        const Pack<4> ex = (x - n.x.v[k]) * n.root_s.v[k], ez = (z - n.z.v[k]) * n.root_s.v[k];
        const Pack<4> ea = (a - n.a.v[k]) * n.root_u.v[k], eb = (b - n.b.v[k]) * n.root_u.v[k];
        change += (ex * ex + ez * ez) + (m.mu_s * m.mu_s) * (ea * ea + eb * eb);
        n.x.v[k] = x;
        n.z.v[k] = z;
        n.a.v[k] = a;
        n.b.v[k] = b;
    }
    return change;
}

// Adds the impulses of a stretch to the state and to the total.
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

// Solves one stretch. Returns false if the sweeps do not converge; then only `stretch` has changed. The first `exact`
// sweeps compute fresh roots, later ones correct those of the sweep before; `root_s` is 1/|s| at the start.
template <int N, End kEnd>
CAROM_INLINE bool collocate(const Model& m, State& state, Impulses& total, Stretch& stretch, double root_s,
                            int exact) {
    using G = Gauss<N>;
    const State start = state;
    Nodes<N> n;
    // First guess: the friction between the balls stays as at the start, and the cloth exerts no force.
    const double share = m.mu_b * root_s;
    const double xi0 = share * start.x, zeta0 = share * start.z;
    for (int k = 0; k < N / 4; ++k) {
        const Pack<4> p = stretch.h * load<4>(G::nodes + 4 * k);
        n.x.v[k] = start.x - p * (7.0 * xi0);
        n.z.v[k] = start.z - p * (5.0 * zeta0);
        n.a.v[k] = start.a + p * xi0;
        n.b.v[k] = start.b + p * (1.0 - m.sigma * zeta0);
    }
    forces<N, true>(m, n);
    const double reach = 7.0 * m.mu_b * stretch.h;
    // A change of the slips leaves an error of contraction * change in the next forces, which act over `reach`.
    Pack<4> tight = n.root_s.v[0] * n.root_s.v[0] + (m.mu_s * m.mu_s) * (n.root_u.v[0] * n.root_u.v[0]);
    if constexpr (N == 8) {
        tight += n.root_s.v[1] * n.root_s.v[1] + (m.mu_s * m.mu_s) * (n.root_u.v[1] * n.root_u.v[1]);
    }
    const double steep = sum(tight), slope = (reach * reach) * (reach * reach) * (steep * (1.0 / (N * N)));
    const double end_slope = 40.0 * ((m.mu_b * m.mu_b) * (m.mu_s * m.mu_s));
    bool converged = false;
    double dh_before = 0.0, t_c = 2.0 / (1.0 + m.e_b) - 1.0;
    EndRows<N> rows;
    if constexpr (kEnd == End::kWhole) set_rows<N>(t_c, rows);
    int k = 1;
    for (; k < kMostSweeps && !converged; ++k) {
        const double h = stretch.h;
        const Pack<4> change = slips<N>(m, start, h, n);
        find_end<N, kEnd>(m, start, n.g_b, rows, stretch);
        // The rows follow the end of compression one sweep late, so that no sweep has to wait for them.
        if constexpr (kEnd == End::kWhole) {
            if (absolute(t_c - rows.t) * m.mu_b * m.mu_s > stretch.row_goal) set_rows<N>(t_c, rows);
            t_c = 2.0 * stretch.p_c / stretch.h - 1.0;
        }
        const Pack<4> root = k < exact ? forces<N, true>(m, n) : forces<N, false>(m, n);
        const double dh = stretch.h - h;
        // The end is the fixed point of an iteration too, with a contraction of at most a few mu_s mu_b.
        const double r = sum(root);
        // Many sweeps mean a contraction near 1: then the error that is left exceeds the last change.
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
    find_end<N, kEnd>(m, start, n.g_b, rows, stretch);
    const double h = stretch.h;
    const double xi = h * dot<N>(G::weights, n.xi), zeta = h * dot<N>(G::weights, n.zeta);
    const double g_a = h * dot<N>(G::weights, n.g_a), g_b = h * dot<N>(G::weights, n.g_b);
    const double tx = dot<N>(G::top, n.xi), tz = dot<N>(G::top, n.zeta), ta = dot<N>(G::top, n.g_a),
                 tb = dot<N>(G::top, n.g_b);
    stretch.s_top = square_root(tx * tx + tz * tz);
    stretch.g_top = square_root(ta * ta + tb * tb);
    if constexpr (kEnd != End::kWhole) stretch.done = start.v * h + h * h * (1.0 - late_share<N>(n.g_b));
    add_stretch(m, {h, xi, zeta, g_a, g_b}, state, total);
    return true;
}

}  // namespace
}  // namespace carom::kernel
