// Chooses the method for an impact, and solves impacts in stretches if no single collocation suffices.
// Symbols: collocation.h.
#pragma once

#include "carom/kernel/tolerance.h"
#include "tolerance/collocation.h"

namespace carom::kernel {
namespace {

// Most stretches of one impact; only degenerate input needs this many.
constexpr int kMostStretches = 2000;

// The error of one collocation of 4 nodes is at most kSizeS mu_b rho_s^-6 + kSizeU mu_b mu_s rho_u^-5, and of
// one of 8 nodes kSizeS mu_b rho_s^-12 + kSizeU/2 mu_b mu_s rho_u^-10, with a margin of 4 or more: fitted to
// random impacts.
constexpr double kSizeS = 1.0, kSizeU = 1.2;

// The sum of the axes if no singularity is near.
constexpr double kFarAway = 1e20;

// From this tolerance on, stretches of 4 nodes are hardly shorter than stretches of 8, and cost less.
constexpr double kLooseStretches = 1e-4;

// An impact in canonical form, scaled by the approach speed.
struct Problem {
    Model model;
    State start;
    double tolerance;
    bool from_rest;  // the cloth slip is zero (rolling, at rest): it starts in the direction of its force
};

struct Solution {
    Impulses total;
    int sweeps;
    ToleranceMethod method;
};

// Powers of rho, the Bernstein ellipse about [0, 1] on which a singularity lies: the error of N nodes falls
// as rho^-2N. Computed without a root from the sum of its axes rho + 1/rho >= 2, because rho^n + rho^-n is a
// polynomial of that sum. The values are up to 1 below the powers.
template <class T>
struct Powers {
    T five, six, ten, twelve;
};

template <class T>
CAROM_INLINE Powers<T> powers(T sum_of_axes) {
    const T S = sum_of_axes, S2 = S * S;
    const T five = S * ((S2 - 5.0) * S2 + 5.0), three = S * (S2 - 3.0), six = three * three - 2.0;
    return {five - 1.0, six - 1.0, five * five - 3.0, six * six - 3.0};
}

// Whether one collocation of 4 or of 8 nodes keeps the tolerance, given the ellipses of the slips s and u.
template <class T>
CAROM_INLINE auto four_will_do(const Powers<T>& s, const Powers<T>& u, T mu_b, T mu_s, double tolerance) {
    return (tolerance * s.six >= kSizeS * mu_b) & (tolerance * u.five >= kSizeU * (mu_b * mu_s));
}

template <class T>
CAROM_INLINE auto eight_will_do(const Powers<T>& s, const Powers<T>& u, T mu_b, T mu_s, double tolerance) {
    return (tolerance * s.twelve >= kSizeS * mu_b) & (tolerance * u.ten >= 0.5 * kSizeU * (mu_b * mu_s));
}

// |s|^2/mu_b times the fastest rate at which |s| can shrink; the cloth force adds up to (1 + 2.5^2)^(1/2)
// mu_s mu_b z/|s|.
CAROM_INLINE double fall(const Model& m, const State& at, double s) {
    return (7.0 * (at.x * at.x) + 5.0 * (at.z * at.z)) + (2.7 * m.mu_s) * (at.z * s);
}

// The rest of an impact after friction has ended.
CAROM_INLINE void finish_frictionless(double v, double work_left, bool compressing, double compressed,
                                      double e_b, Impulses& total) {
    if (compressing) {
        total.p += -0.5 * v;
        work_left = e_b * e_b * (compressed + 0.25 * v * v);
        v = 0.0;
    }
    if (work_left > 0.0) total.p += 2.0 * work_left / (v + square_root(v * v + 4.0 * work_left));
}

// The rest of an impact whose slip has nearly vanished. The slip ends while the cloth slip keeps its
// direction; if the remaining impulse is too small to end it, the friction impulses are reduced in
// proportion.
inline void finish_stuck(const Model& m, State at, double left, Impulses& total, double& v) {
    const double s = square_root(at.x * at.x + at.z * at.z), u = square_root(at.a * at.a + at.b * at.b);
    const double ga = u > 0.0 ? m.mu_s * (at.a / u) : 0.0, gb = u > 0.0 ? m.mu_s * (at.b / u) : 0.0;
    const double need = s / (5.0 * m.mu_b);
    const double share = left < need ? left / need : 1.0;
    const double zeta = share * (at.z / (5.0 - 2.5 * gb));
    total.zeta += zeta;
    total.g_a += ga * zeta;
    total.g_b += gb * zeta;
    total.xi += (share * at.x + ga * zeta) / 7.0;
    v -= gb * zeta;
}

// Ellipses of stretches, each 1.125 times the previous one: rho^6 (4 nodes) or rho^12 (8 nodes), and the sum
// of the axes.
template <int N>
struct Ellipses {
    static constexpr int kCount = 33;
    double power[kCount - 1], sum_of_axes[kCount];
    constexpr Ellipses() : power{}, sum_of_axes{} {
        double rho = 1.6;
        for (int i = 0; i < kCount; ++i) {
            const double r2 = rho * rho, r6 = r2 * r2 * r2;
            if (i < kCount - 1) power[i] = N == 4 ? r6 : r6 * r6;
            sum_of_axes[i] = rho + 1.0 / rho;
            rho *= 1.125;
        }
    }
};
template <int N>
constexpr Ellipses<N> kEllipses;

// The sum of the axes of the smallest ellipse for which N nodes keep an error that is this multiple of the
// tolerance for rho = 1.
template <int N>
CAROM_INLINE double needed_axes(double excess) {
    // The powers increase. All are compared at once, so that no comparison waits for another.
    unsigned too_small = 0;
    for (int i = 0; i < Ellipses<N>::kCount - 1; i += 8)
        too_small |= static_cast<unsigned>(bits_less(load<8>(kEllipses<N>.power + i), broadcast<8>(excess)))
                     << i;
    return kEllipses<N>.sum_of_axes[too_small == ~0u ? Ellipses<N>::kCount - 1 : __builtin_ctz(~too_small)];
}

// The last resort, which always makes progress: one explicit Euler step over a negligible stretch.
inline void frozen_step(const Model& m, double h, State& at, Impulses& total, double& done) {
    const double s = square_root(at.x * at.x + at.z * at.z), u = square_root(at.a * at.a + at.b * at.b);
    const double xi = s > 0.0 ? m.mu_b * (at.x / s) * h : 0.0, zeta = s > 0.0 ? m.mu_b * (at.z / s) * h : 0.0;
    const double ga = u > 0.0 ? m.mu_s * zeta * (at.a / u) : 0.0,
                 gb = u > 0.0 ? m.mu_s * zeta * (at.b / u) : 0.0;
    done = at.v * h + h * h;
    at.x += ga - 7.0 * xi;
    at.z = largest(0.0, at.z + (2.5 * gb - 5.0 * zeta));
    at.a += xi - m.kappa * ga;
    at.b += h - (m.sigma * zeta + m.kappa * gb);
    at.v += 2.0 * h - gb;
    total.p += h;
    total.xi += xi;
    total.zeta += zeta;
    total.g_a += ga;
    total.g_b += gb;
}

// The goals of Stretch.
struct Goals {
    double sweep, root;
};

CAROM_INLINE Goals goals(const Model& m, double tolerance) {
    Goals g;
    const double left = smallest(tolerance, kShareOfFriction * m.mu_b);
    g.sweep = kSweepGoal * (left * left);
    // A correction leaves (5/16) r^3 of r = 1 - |.|^2 T^2, and an error of a direction acts with 7 mu_b.
    g.root = 0.05 * (left * left) / (m.mu_b * m.mu_b);
    return g;
}

CAROM_INLINE bool resolved(const Model& m, const Stretch& stretch, double tolerance) {
    return resolved(m.mu_b, m.mu_s, stretch.h, stretch.s_top2, stretch.g_top2, tolerance);
}

// An impact solved in stretches so short that |s| and |u| keep a fraction of their size. `plan` chooses the
// next stretch; `advance` accepts or rejects the result of its collocation.
struct Adaptive {
    Model m;
    double tolerance, S, shortest;
    State at;
    Impulses total;
    double compressed, left, shrink;
    bool compressing, from_rest;
    int sweeps, stretches;
    // The planned stretch.
    double end, asked, root_s;
    bool last;
};

template <int N>
CAROM_INLINE void begin_adaptive(const Problem& problem, Adaptive& run) {
    run.m = problem.model;
    run.tolerance = problem.tolerance;
    run.at = problem.start;
    run.total = {0.0, 0.0, 0.0, 0.0, 0.0};
    run.S = needed_axes<N>(0.3 * run.m.mu_b / run.tolerance);
    run.shortest = 1e-3 * run.tolerance / run.m.mu_b;
    run.compressing = true;
    run.from_rest = problem.from_rest;
    run.compressed = run.left = 0.0;
    run.shrink = 1.0;
    run.sweeps = run.stretches = 0;
}

// Returns false if the slip has almost vanished: then only the frictionless rest of the impact remains.
CAROM_INLINE bool plan(Adaptive& run) {
    const Model& m = run.m;
    State& at = run.at;
    const double end =
        run.compressing ? -0.5 * at.v : 2.0 * run.left / (at.v + square_root(at.v * at.v + 4.0 * run.left));
    const double total_left = run.compressing ? end * (1.0 + m.e_b) : end;
    const double ss = at.x * at.x + at.z * at.z, s = square_root(ss), root_s = inverse_root(ss);
    const double uu = at.a * at.a + at.b * at.b, u = square_root(uu);
    const bool surely_sticks = total_left * m.mu_b * 2.0 > s;
    const double vanished2 = surely_sticks ? run.tolerance * m.mu_b * smallest(u, 1.0) : 0.0;
    if (ss <= vanished2 || s <= 0.25 * run.tolerance) {
        finish_stuck(m, at, total_left, run.total, at.v);
        return false;
    }
    const double S = run.S;
    // From here divide only at the end, because the next stretch waits for this.
    double h = 4.0 * (s * ss) / ((m.mu_b * (S + 2.0)) * fall(m, at, s));
    if (!run.from_rest) {
        // (fx, fy) is |s| |u| u'. The cloth force itself accelerates or delays the approach of u to zero.
        const double drag = (m.kappa * (m.mu_s * m.mu_b)) * at.z, su = s * u;
        const double fx = (m.mu_b * at.x) * u - drag * at.a,
                     fy = su - ((m.sigma * m.mu_b) * at.z) * u - drag * at.b;
        const double f2 = fx * fx + fy * fy,
                     beside = su * (S * (u * square_root(f2)) + 2.0 * (at.a * fx + at.b * fy));
        const double by_cloth = beside / (f2 * (0.25 * S * S - 1.0));
        h = smallest(h, f2 > 0.0 ? by_cloth : 0.0);
    }
    h = largest(run.shrink * smallest(h, 1.25 * end), run.shortest);
    run.end = end;
    run.root_s = root_s;
    run.last = h >= 1.1 * end;
    run.asked = run.last ? end : smallest(h, 0.6 * end);
    return true;
}

// Returns false after the last stretch. `done` is the work of the normal impulse over the stretch.
CAROM_INLINE bool advance(Adaptive& run, bool ok, State next, Impulses sum_next, double done) {
    if (!ok) {
        if (run.asked > run.shortest) {
            run.shrink *= 0.4;
            return true;
        }
        next = run.at;
        sum_next = run.total;
        frozen_step(run.m, smallest(run.shortest, run.end), next, sum_next, done);
        run.from_rest = false;
    }
    run.shrink = smallest(1.0, 1.6 * run.shrink);
    run.at = next;
    run.total = sum_next;
    if (run.compressing)
        run.compressed -= done;
    else
        run.left -= done;
    if (run.compressing && (run.at.v >= 0.0 || (ok && run.last))) {
        run.compressing = false;
        run.left = run.m.e_b * run.m.e_b * run.compressed;
        run.at.v = 0.0;
        return run.left > 0.0;
    }
    if (!run.compressing && (!(run.left > 0.0) || (ok && run.last))) {
        run.left = 0.0;
        return false;
    }
    return true;
}

CAROM_INLINE void finish(Adaptive& run) {
    finish_frictionless(run.at.v, run.left, run.compressing, run.compressed, run.m.e_b, run.total);
    if (run.sweeps == 0) run.sweeps = 1;  // the slip was so small that it ended at once
}

// Returns false at the limit of stretches: then `solution` is finite but may miss the tolerance.
template <int N>
inline bool solve_adaptive(const Problem& problem, Solution& solution) {
    Adaptive run;
    begin_adaptive<N>(problem, run);
    const Goals goal = goals(run.m, run.tolerance);
    for (; run.stretches < kMostStretches; ++run.stretches) {
        if (!plan(run)) break;
        Stretch stretch{run.asked, run.left, 0.0, 0.0, 0.0, goal.sweep, goal.root, 0.0, 0.0, 0, !run.last};
        State next = run.at;
        Impulses sum_next = run.total;
        const bool exact = run.shrink < 1.0;
        bool ok = collocate<N, End::kStretch>(run.m, next, sum_next, stretch, run.root_s, exact);
        run.sweeps += stretch.sweeps;
        ok = ok && resolved(run.m, stretch, run.tolerance);
        if (!advance(run, ok, next, sum_next, stretch.done)) break;
    }
    finish(run);
    solution.method = ToleranceMethod::kAdaptive;
    solution.sweeps = run.sweeps;
    solution.total = run.total;
    return run.stretches < kMostStretches;
}

template <int N>
CAROM_INLINE bool solve_whole(const Problem& problem, double guess, double root_s, Solution& solution) {
    const Goals goal = goals(problem.model, problem.tolerance);
    Stretch stretch{guess, 0.0, 0.5, 0.0,  kRowsGoal * problem.tolerance, goal.sweep, goal.root,
                    0.0,   0.0, 0,   false};
    State state = problem.start;
    solution.total = {0.0, 0.0, 0.0, 0.0, 0.0};
    const bool ok = collocate<N, End::kWhole>(problem.model, state, solution.total, stretch, root_s, false);
    solution.sweeps = stretch.sweeps;
    solution.method = N == 4 ? ToleranceMethod::kCollocation4 : ToleranceMethod::kCollocation8;
    return ok && resolved(problem.model, stretch, problem.tolerance);
}

// The closed forms: no friction between the balls, or no vertical slip and therefore no cloth force.
CAROM_INLINE void solve_closed(const Problem& problem, Solution& solution) {
    const Model& m = problem.model;
    const double x = problem.start.x, p = 0.5 * (1.0 + m.e_b);
    solution.total = {p, 0.0, 0.0, 0.0, 0.0};
    solution.sweeps = 1;
    solution.method = ToleranceMethod::kClosedFrictionless;
    if (m.mu_b == 0.0) return;
    solution.method = ToleranceMethod::kClosedGearing;
    if (x == 0.0) return;
    solution.method = ToleranceMethod::kClosedStick;
    const double most = m.mu_b * p, stop = magnitude(x) / 7.0, xi = most < stop ? most : stop;
    solution.total.xi = x < 0.0 ? -xi : xi;
}

// Chooses the cheapest method that keeps the tolerance.
CAROM_INLINE void solve(const Problem& problem, Solution& solution) {
    const Model& m = problem.model;
    const State& start = problem.start;
    if (m.mu_b == 0.0 || start.z == 0.0) {
        solve_closed(problem, solution);
        return;
    }
    const double guess = 0.5 * (1.0 + m.e_b);
    const double ss = start.x * start.x + start.z * start.z, s = square_root(ss), root_s = inverse_root(ss);
    // Distances of the singularities: stick is straight ahead, and the zero of the cloth slip is beside its
    // nearly straight path.
    const double axes_s = 4.0 * (s * ss) / ((guess * m.mu_b) * fall(m, start, s)) - 2.0;
    double axes_u = kFarAway;
    if (!problem.from_rest) {
        const double by_path = 2.0 / (guess * (1.0 + magnitude(m.sigma) * m.mu_b)),
                     by_s = (guess * m.mu_b) * root_s;
        const double a1 = start.a + by_s * start.x, b1 = (start.b + guess) - m.sigma * (by_s * start.z);
        const double u0 = square_root(start.a * start.a + start.b * start.b),
                     u1 = square_root(a1 * a1 + b1 * b1);
        // The cloth force bends this path by at most `bend`.
        const double bend = guess * (magnitude(m.kappa) * (m.mu_s * m.mu_b));
        axes_u = ((u0 + u1) - bend) * by_path;
    }
    const Powers<double> rho_s = powers(largest(axes_s, 2.0));
    const Powers<double> rho_u = powers(largest(axes_u, 2.0));
    solution.sweeps = 0;
    if (four_will_do(rho_s, rho_u, m.mu_b, m.mu_s, problem.tolerance)) {
        if (solve_whole<4>(problem, guess, root_s, solution)) return;
    }
    if (eight_will_do(rho_s, rho_u, m.mu_b, m.mu_s, problem.tolerance)) {
        if (solve_whole<8>(problem, guess, root_s, solution)) return;
    }
    if (problem.tolerance >= kLooseStretches && solve_adaptive<4>(problem, solution)) return;
    solve_adaptive<8>(problem, solution);
}

}  // namespace
}  // namespace carom::kernel
