// Gauss collocation of the impact over one stretch of the normal impulse, solved by Picard sweeps.
//
// All quantities are per unit mass and scaled by the approach speed (docs/design/impact_kernel.md). s = (x,
// z) is the slip between the balls, z >= 0; u = (a, b) is the slip of the active ball, which is pressed on
// the cloth; p is the normal impulse; v is the normal velocity, -1 at the start. The forces are
//
//     xi = mu_b x/|s|   zeta = mu_b z/|s|   g_a = mu_s zeta a/|u|   g_b = mu_s zeta b/|u|
//
// and the equations of motion, with ' = d/dp,
//
//     x' = -7 xi + g_a     z' = -5 zeta + 5/2 g_b     a' = xi - kappa g_a
//     b' = 1 - sigma zeta - kappa g_b                 v' = 2 - g_b
//
// with (sigma, kappa = 1 - sigma) = (-5/2, 7/2) for the consistent sign of the cloth slip, (5/2, -3/2) as
// published.
#pragma once

#include "frame.h"
#include "gauss.h"
#include "loop_marks.h"
#include "simd.h"

namespace carom::kernel {
namespace {

// Most Picard sweeps of one collocation. One that converges more slowly is solved in shorter stretches.
constexpr int kMostSweeps = 24;

// Sweeps of 4 nodes before those of 8. Each costs half as much and reduces the error of the first guess
// equally. The part that 4 nodes do not resolve is left to the sweeps of 8; with 3, hardly any of those are
// saved.
constexpr int kCoarseSweeps = 2;

// The square of the estimated error that the iteration may leave, in tolerances. The estimate is pessimistic,
// and fitted like the guards: with 20 the largest error of 360 000 random and hard impacts of the single form
// is two thirds of the bound; with 48 one exceeds it. Lanes have narrower margins.
constexpr double kSweepGoal = 20.0, kSweepGoalOfLanes = 16.0;

// Largest error that the iteration may leave, relative to the friction between the balls. For slight
// friction, an error of the tolerance could exceed all that friction removes, and energy would rise.
constexpr double kShareOfFriction = 0.03;

// The error of the rows (EndRows), relative to the tolerance, above which they are recomputed.
constexpr double kRowsGoal = 0.1;

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

// The end of a collocation.
enum class End : unsigned char {
    kWhole,  // at the end of restitution, from v = -1; the end of compression is inside
    // after a given impulse; or at the end of compression, v = 0; or at the end of restitution, after a given
    // work
    kStretch,
};

// The task of a collocation, and its result.
struct Stretch {
    double h;           // impulse: given, or a first guess and then the result
    double work;        // kStretch: the work to do; 0: until v = 0
    double p_c;         // kWhole: impulse at the end of compression, a first guess and then the result
    double done;        // kStretch: work of the normal impulse over the stretch
    double row_goal;    // largest error of the end's rows
    double sweep_goal;  // square of the largest error that the iteration may leave
    // sixth power of the largest relative error of a carried root before its last correction
    double root_goal;
    // The square of the highest Legendre coefficient of (xi, zeta), and of (g_a, g_b): the resolution of the
    // nodes.
    double s_top2, g_top2;
    int sweeps;
    bool given;  // kStretch: the impulse is given
};

// The sum over j of column j of the table, which has N rows, times f_j.
template <int N, class P>
CAROM_INLINE Pack<N> combine(const double* table, P f) {
    const auto column = [&](int j) { return load<N>(table + N * j); };
    Pack<N> total = (column(0) * spread_lane<N, 0>(f) + column(1) * spread_lane<N, 1>(f)) +
                    (column(2) * spread_lane<N, 2>(f) + column(3) * spread_lane<N, 3>(f));
    if constexpr (sizeof f == 8 * sizeof *table) {
        total += (column(4) * spread_lane<N, 4>(f) + column(5) * spread_lane<N, 5>(f)) +
                 (column(6) * spread_lane<N, 6>(f) + column(7) * spread_lane<N, 7>(f));
    }
    return total;
}

template <int N>
CAROM_INLINE double dot(const double* weights, Pack<N> f) {
    return sum(load<N>(weights) * f);
}

// Rows that integrate a force over compression and over restitution, for an end of compression at t_c = 2
// p_c/p - 1.
template <int N>
struct EndRows {
    double t;  // the t_c of these rows
    Pack<N> before, before_late, after_late;
};

template <int N>
CAROM_INLINE Pack<N> row_at(const double* table, double t, double unit) {
    const Pack<N> T = broadcast<N>(t), T2 = T * T;
    const auto coefficient = [&](int power) { return load<N>(table + N * power); };
    Pack<N> value = (coefficient(0) + coefficient(1) * T) + (coefficient(2) + coefficient(3) * T) * T2;
    if constexpr (N == 8) {
        value +=
            ((coefficient(4) + coefficient(5) * T) + (coefficient(6) + coefficient(7) * T) * T2) * (T2 * T2);
    }
    return value * unit;
}

// The rows act on a force in units of `unit`.
template <int N>
CAROM_INLINE void set_rows(double t, double unit, EndRows<N>& rows) {
    rows.t = t;
    rows.before = row_at<N>(Gauss<N>::before[0], t, unit);
    rows.before_late = row_at<N>(Gauss<N>::before_late[0], t, unit);
    rows.after_late = row_at<N>(Gauss<N>::after_late[0], t, unit);
}

// Int_0^1 (1 - tau) f dtau
template <int N>
CAROM_INLINE double late_share(Pack<N> f) {
    return dot<N>(Gauss<N>::weights, (1.0 - load<N>(Gauss<N>::nodes)) * f);
}

// The impulse at which the stretch ends, by quadrature of the cloth force mu_b mu_s g_b. Compression ends at
// v = 0, restitution when the work of the normal impulse is e_b^2 times that of compression.
template <int N, End kEnd>
CAROM_INLINE void find_end(const Model& m, const State& start, Pack<N> g_b, const EndRows<N>& rows,
                           Stretch& stretch) {
    using G = Gauss<N>;
    const double unit = m.mu_b * m.mu_s;
    if constexpr (kEnd == End::kWhole) {
        // With p_c = 1/share the work of compression is (share - 1 + late)/share^2: division and root do not
        // wait for each other.
        const double share = 2.0 - sum(rows.before * g_b), lost = 1.0 - sum(rows.after_late * g_b);
        const double late = sum(rows.before_late * g_b), both = 1.0 / (lost * share);
        stretch.p_c = both * lost;
        stretch.h = both * (lost + m.e_b * square_root(lost * (share - (1.0 - late))));
    } else if (stretch.given) [[likely]] {
        // One function for all ends of a stretch: with a whole impact of 4 and of 8 nodes the code only just
        // fits into 32 kB.
        return;
    } else if (stretch.work == 0.0) {
        stretch.h = -start.v / (2.0 - unit * dot<N>(G::weights, g_b));
    } else {
        const double lost = 1.0 - unit * late_share<N>(g_b);
        stretch.h =
            2.0 * stretch.work / (start.v + square_root(start.v * start.v + 4.0 * lost * stretch.work));
    }
}

// The values at the nodes. Forces are in units of mu_b, those of the cloth in units of mu_b mu_s.
template <int N>
struct Nodes {
    Pack<N> x, z, a, b;          // the slips
    Pack<N> root_s, root_u;      // 1/|s|, 1/|u|
    Pack<N> xi, zeta, g_a, g_b;  // the forces
};

// |.|^2 T^2 of the carried roots T before their correction; 1 if computed afresh.
template <int N>
struct Carried {
    Pack<N> s, u;
};

// 1/sqrt(v), to 1.5 ulp. The division does not wait for the root.
template <class P>
CAROM_INLINE P inverse_root(P v) {
    return square_root(v) * (1.0 / v);
}

// Forces at the nodes. The reciprocal roots are computed afresh (kExact), or those of the previous sweep are
// corrected by one cubic step: T f, f = 15/8 - 5/4 q + 3/8 q^2 > 0 with q = |.|^2 T^2. Every sweep waits for
// this, so the slips are scaled before the factor is known.
template <int N, bool kExact>
CAROM_INLINE Carried<N> forces(Nodes<N>& n) {
    Carried<N> q;
    Pack<N> e_a, e_b;
    if constexpr (kExact) {
        n.root_s = inverse_root(n.x * n.x + n.z * n.z);
        n.root_u = inverse_root(n.a * n.a + n.b * n.b);
        n.xi = n.root_s * n.x;
        n.zeta = n.root_s * n.z;
        e_a = n.root_u * n.a;
        e_b = n.root_u * n.b;
        q.s = q.u = broadcast<N>(1.0);
    } else {
        const Pack<N> x = n.x * n.root_s, z = n.z * n.root_s, a = n.a * n.root_u, b = n.b * n.root_u;
        const Pack<N> s = x * x + z * z, u = a * a + b * b;
        const Pack<N> by_s = (1.875 - 1.25 * s) + 0.375 * (s * s),
                      by_u = (1.875 - 1.25 * u) + 0.375 * (u * u);
        n.root_s = n.root_s * by_s;
        n.root_u = n.root_u * by_u;
        n.xi = x * by_s;
        n.zeta = z * by_s;
        e_a = a * by_u;
        e_b = b * by_u;
        q = {s, u};
    }
    n.g_a = n.zeta * e_a;
    n.g_b = n.zeta * e_b;
    return q;
}

// Whether the sixth powers of the relative errors of the carried roots were below the goal.
template <int N>
CAROM_INLINE bool roots_settled(const Carried<N>& q, double goal) {
    const Pack<N> worst = (1.0 - q.s) * (1.0 - q.s) + (1.0 - q.u) * (1.0 - q.u);
    return all_below(worst * worst * worst, goal);
}

// The slips at N nodes from the forces at as many or fewer, by the table of the forces' integrals. Changes
// nothing else in `n`.
template <int N, class Forces>
CAROM_INLINE void slips(const Model& m, const State& start, double h, const double* table, const Forces& f,
                        Nodes<N>& n) {
    const Pack<N> H = broadcast<N>(h);
    const Pack<N> xi = combine<N>(table, f.xi), zeta = combine<N>(table, f.zeta);
    const Pack<N> g_a = combine<N>(table, f.g_a), g_b = combine<N>(table, f.g_b);
    const double cloth = m.mu_b * m.mu_s;
    n.x = (start.x - (H * (7.0 * m.mu_b)) * xi) + (H * cloth) * g_a;
    n.z = (start.z - (H * (5.0 * m.mu_b)) * zeta) + (H * (2.5 * cloth)) * g_b;
    n.a = (start.a + (H * m.mu_b) * xi) - (H * (m.kappa * cloth)) * g_a;
    n.b = (start.b + H * load<N>(Gauss<N>::nodes) - (H * (m.sigma * m.mu_b)) * zeta) -
          (H * (m.kappa * cloth)) * g_b;
}

// The slips of one sweep and of the previous one, and the roots of the latter, for any number of nodes.
template <class P>
struct Change {
    P x, z, a, b, old_x, old_z, old_a, old_b, root_s, root_u;
};

// The squares of the changes relative to |s| and to |u|, the latter weighted by its largest possible effect.
template <class P>
CAROM_INLINE P squares(const Change<P>& c, double mu_s) {
    const P dx = c.x - c.old_x, dz = c.z - c.old_z, da = c.a - c.old_a, db = c.b - c.old_b;
    return (dx * dx + dz * dz) * (c.root_s * c.root_s) +
           (mu_s * mu_s) * ((da * da + db * db) * (c.root_u * c.root_u));
}

// Whether `small`, which must be monotone, holds for the sum of the squares over all nodes. For all sweeps
// except the last, the later half of the nodes suffices, because they change most.
template <class Register, class Small>
CAROM_INLINE bool changed_little(const Change<Register>& c, double mu_s, Small small) {
    return small(sum(squares(c, mu_s)));
}

template <class Half, class Small>
CAROM_INLINE bool changed_little(const Change<Halves<Half>>& c, double mu_s, Small small) {
    const Half late = squares<Half>({c.x.hi, c.z.hi, c.a.hi, c.b.hi, c.old_x.hi, c.old_z.hi, c.old_a.hi,
                                     c.old_b.hi, c.root_s.hi, c.root_u.hi},
                                    mu_s);
    if (!small(sum(late))) [[likely]]
        return false;
    const Half early = squares<Half>({c.x.lo, c.z.lo, c.a.lo, c.b.lo, c.old_x.lo, c.old_z.lo, c.old_a.lo,
                                      c.old_b.lo, c.root_s.lo, c.root_u.lo},
                                     mu_s);
    return small(sum(early + late));
}

// First guess. The cloth slip moves straight, as if by the normal impulse alone, and its middle determines
// the cloth's force. The slip between the balls turns under the forces at the start. The end of a whole
// impact is estimated with that cloth force.
template <int N, End kEnd>
CAROM_INLINE void guess(const Model& m, const State& start, double root_s, Stretch& stretch, Nodes<N>& n) {
    const double e_x = root_s * start.x, e_z = root_s * start.z, xi = m.mu_b * e_x, zeta = m.mu_b * e_z;
    const double half = start.b + 0.5 * stretch.h;
    // The direction of a small cloth slip soon turns, so it counts less.
    const double by_u = m.mu_s * inverse_root((start.a * start.a + half * half) + 0.01);
    const double g_a = (by_u * start.a) * zeta, g_b = (by_u * half) * zeta;
    const double x = g_a - 7.0 * xi, z = 2.5 * g_b - 5.0 * zeta;
    const double turn = (e_x * z - e_z * x) * (0.5 * root_s);
    const double x2 = 7.0 * (turn * zeta), z2 = -5.0 * (turn * xi);
    const double a = xi - m.kappa * g_a, b = 1.0 - (m.sigma * zeta + m.kappa * g_b);
    if constexpr (kEnd == End::kWhole) stretch.h += (0.5 * stretch.h) * g_b;
    const Pack<N> p = stretch.h * load<N>(Gauss<N>::nodes);
    n.x = start.x + p * (x + p * x2);
    n.z = start.z + p * (z + p * z2);
    n.a = start.a + p * a;
    n.b = start.b + p * b;
}

// The initial slips, roots and forces of the sweeps. For a whole impact, returns the end of compression
// (EndRows::t). The roots of 8 nodes are computed afresh: 1/|u| of a ball that rolled is no polynomial, and
// carried roots cost up to two sweeps.
template <int N, End kEnd>
CAROM_INLINE double begin(const Model& m, const State& start, double root_s, Stretch& stretch, Nodes<N>& n) {
    double t_c = 2.0 / (1.0 + m.e_b) - 1.0;
    if constexpr (N == 4) {
        guess<4, kEnd>(m, start, root_s, stretch, n);
    } else {
        Nodes<4> coarse;
        begin<4, kEnd>(m, start, root_s, stretch, coarse);
        EndRows<4> rows;
        if constexpr (kEnd == End::kWhole) set_rows<4>(t_c, m.mu_b * m.mu_s, rows);
        for (int k = 0; k < kCoarseSweeps; ++k) {
            slips<4>(m, start, stretch.h, Gauss<4>::integral[0], coarse, coarse);
            find_end<4, kEnd>(m, start, coarse.g_b, rows, stretch);
            forces<4, false>(coarse);
        }
        stretch.sweeps += kCoarseSweeps;
        slips<N>(m, start, stretch.h, Finer::integral[0], coarse, n);
        if constexpr (kEnd == End::kWhole) {
            find_end<4, kEnd>(m, start, coarse.g_b, rows, stretch);
            t_c = 2.0 * stretch.p_c / stretch.h - 1.0;
        }
    }
    forces<N, true>(n);
    return t_c;
}

// Whether the nodes of a stretch of the impulse h resolve its forces, by the squares of their highest
// Legendre coefficients: 7 h s^2 is at most 3 tolerances times mu_b, and 9 h^2 g^3 at most mu_b mu_s times
// the square of the tolerance.
template <class T>
CAROM_INLINE auto resolved(T mu_b, T mu_s, T h, T s_top2, T g_top2, double tolerance) {
    const T g_side = 9.0 * (h * h), side = (tolerance * tolerance) * (mu_b * mu_s);
    return (7.0 * h * s_top2 <= 3.0 * tolerance * mu_b) &
           ((g_side * g_side) * (g_top2 * g_top2 * g_top2) <= side * side);
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

// Solves one stretch. Returns false if the sweeps do not converge; then only `stretch` has changed. `exact`:
// compute fresh roots in every sweep instead of correcting the previous ones. `root_s` is 1/|s| at the start.
template <int N, End kEnd>
CAROM_INLINE bool collocate(const Model& m, State& state, Impulses& total, Stretch& stretch, double root_s,
                            bool exact) {
    using G = Gauss<N>;
    const State start = state;
    Nodes<N> n;
    double t_c = begin<N, kEnd>(m, start, root_s, stretch, n);
    const double reach = 7.0 * m.mu_b * stretch.h, cloth = m.mu_b * m.mu_s;
    // A change of the slips leaves an error of contraction * change in the next forces, which act over
    // `reach`.
    const double steep = sum(n.root_s * n.root_s + (m.mu_s * m.mu_s) * (n.root_u * n.root_u)),
                 slope = (reach * reach) * (reach * reach) * (steep * (1.0 / (N * N)));
    // The end is also the fixed point of an iteration, with a contraction of at most a few mu_s mu_b.
    const double end_slope = steep * slope + 40.0 * (cloth * cloth);
    bool converged = false;
    EndRows<N> rows;
    if constexpr (kEnd == End::kWhole) set_rows<N>(t_c, cloth, rows);
    int k = 1;
    for (; k < kMostSweeps && !converged; ++k) {
        CAROM_LOOP_BEGIN("sweep");
        const double h = stretch.h;
        const Nodes<N> old = n;
        slips<N>(m, start, h, G::integral[0], n, n);
        find_end<N, kEnd>(m, start, n.g_b, rows, stretch);
        // The rows follow the end of compression one sweep late, so that no sweep waits for them.
        if constexpr (kEnd == End::kWhole) {
            if (magnitude(t_c - rows.t) * cloth > stretch.row_goal) set_rows<N>(t_c, cloth, rows);
            t_c = 2.0 * stretch.p_c / stretch.h - 1.0;
        }
        const Carried<N> carried = exact ? forces<N, true>(n) : forces<N, false>(n);
        const double dh = stretch.h - h;
        // Many sweeps mean a contraction near 1, so the remaining error exceeds the last change.
        const double slow = 1.0 + 0.03125 * (k * k);
        const double by_slips = slow * slope, by_end = (slow * end_slope) * (dh * dh);
        const auto small = [&](double change) { return by_slips * change + by_end <= stretch.sweep_goal; };
        const Change<Pack<N>> moved = {n.x,   n.z,   n.a,   n.b,        old.x,
                                       old.z, old.a, old.b, old.root_s, old.root_u};
        CAROM_LOOP_END("sweep");
        const bool settled = changed_little(moved, m.mu_s, small);
        converged = settled && roots_settled<N>(carried, stretch.root_goal);
    }
    stretch.sweeps += k;
    if (!converged) return false;
    find_end<N, kEnd>(m, start, n.g_b, rows, stretch);
    const double h = stretch.h, hb = h * m.mu_b, hg = h * cloth;
    const double xi = hb * dot<N>(G::weights, n.xi), zeta = hb * dot<N>(G::weights, n.zeta);
    const double g_a = hg * dot<N>(G::weights, n.g_a), g_b = hg * dot<N>(G::weights, n.g_b);
    const double tx = dot<N>(G::top, n.xi), tz = dot<N>(G::top, n.zeta), ta = dot<N>(G::top, n.g_a),
                 tb = dot<N>(G::top, n.g_b);
    stretch.s_top2 = (m.mu_b * m.mu_b) * (tx * tx + tz * tz);
    stretch.g_top2 = (cloth * cloth) * (ta * ta + tb * tb);
    if constexpr (kEnd == End::kStretch)
        stretch.done = start.v * h + h * h * (1.0 - cloth * late_share<N>(n.g_b));
    add_stretch(m, {h, xi, zeta, g_a, g_b}, state, total);
    return true;
}

}  // namespace
}  // namespace carom::kernel
