// Impacts of a batch that are solved in stretches. Each lane starts the next impact as soon as it has
// finished one.
#pragma once

#include "tolerance/single.h"
#include "tolerance/wide.h"

namespace carom::kernel {

// One stretch of many impacts, as collocate() for one impact. Symbols: collocation.h. As in wide.h, a lane
// reads only its own numbers.

namespace {

// Sweeps after which a stretch that has not been shortened before is shortened, because the other lanes wait
// for it.
constexpr int kPatience = 10;

struct WideStretch {
    WideModel m;
    WideStart start;
    Wide v, h, work, root_s;  // h: the given impulse, or a first guess
    WideMask to_zero,
        to_work;      // the stretch ends with v = 0 or after the work; otherwise after the impulse h
    WideMask exact;   // compute fresh roots in every sweep
    WideMask wanted;  // lanes with a stretch
    double tolerance;
};

struct WideStretchResult {
    WideResult t;
    Wide done;  // work of the normal impulse
};

// Int_0^1 (1 - tau) f dtau
template <int N>
CAROM_INLINE Wide wide_late_share(const Wide (&f)[N]) {
    using G = Gauss<N>;
    Wide even = (G::weights[0] * (1.0 - G::nodes[0])) * f[0];
    Wide odd = (G::weights[1] * (1.0 - G::nodes[1])) * f[1];
    for (int j = 2; j < N; j += 2) {
        even += (G::weights[j] * (1.0 - G::nodes[j])) * f[j];
        odd += (G::weights[j + 1] * (1.0 - G::nodes[j + 1])) * f[j + 1];
    }
    return even + odd;
}

// As find_end().
template <int N>
CAROM_INLINE Wide wide_stretch_end(const WideStretch& w, WideMask open_end, const Wide (&g_b)[N]) {
    if (!any(open_end)) return w.h;
    const Wide lost = 1.0 - wide_late_share<N>(g_b);
    const Wide share = 2.0 - wide_dot<N>(Gauss<N>::weights, 1, g_b);
    const Wide by_work = w.v + square_root(w.v * w.v + 4.0 * (lost * w.work));
    const Wide h = select(w.to_zero, -w.v, 2.0 * w.work) / select(w.to_zero, share, by_work);
    return select(open_end, h, w.h);
}

template <int N>
CAROM_INLINE void wide_stretch(const WideStretch& w, WideStretchResult& out) {
    const WideModel& m = w.m;
    const WideMask open_end = w.to_zero | w.to_work;
    WideNodes<N> n;
    Wide h = w.h;
    wide_begin<N, false>(m, w.start, w.root_s, h, n,
                         [&](const Wide(&g_b)[4]) { return wide_stretch_end<4>(w, open_end, g_b); });
    const Wide mu2 = m.mu_s * m.mu_s, reach2 = (7.0 * m.mu_b * h) * (7.0 * m.mu_b * h);
    Wide steep = {};
    for (int i = 0; i < N; ++i) steep += n.root_s[i] * n.root_s[i] + mu2 * (n.root_u[i] * n.root_u[i]);
    const Wide slope = (reach2 * reach2) * (steep * (1.0 / (N * N))),
               end_slope = steep * slope + 40.0 * ((m.mu_b * m.mu_b) * mu2);
    const WideGoals goal = wide_goals(m, w.tolerance);
    WideMask open = w.wanted, finished = {}, exact = w.exact;
    WideForces<N> kept = {};
    out.t.sweeps = broadcast<kWidth>(kMostSweeps);
    for (int k = 1; k < kMostSweeps && any(open); ++k) {
        const Wide change = wide_slips<N>(m, w.start, h, n);
        const Wide h_new = wide_stretch_end<N>(w, open_end, n.g_b), dh = h_new - h;
        h = h_new;
        Wide r = {};
        if (any(exact & open))
            r = wide_forces<N, Roots::kMixed>(m, n, exact);
        else
            r = wide_forces<N, Roots::kCarried>(m, n);
        const Wide left = slope * change + end_slope * (dh * dh);
        // A very wrong root may have become negative.
        exact |= ~(r < 1.0);
        const double slow = 1.0 + 0.03125 * (k * k);
        const WideMask now = open & (left * slow <= goal.sweep) & (r * r <= goal.root);
        wide_keep<N>(now, n, kept);
        finished |= now;
        out.t.sweeps = select(now, broadcast<kWidth>(k + 1.0 + kBefore<N>), out.t.sweeps);
        // A NaN never converges, and a stretch that converges slowly costs less as two stretches.
        open &= ~now & (left == left);  // NOLINT(misc-redundant-expression): asks for a NaN
        if (k >= kPatience) open &= w.exact;
    }
    h = wide_stretch_end<N>(w, open_end, kept.g_b);
    out.t.converged = finished & wide_resolved<N>(m, h, w.tolerance, kept);
    wide_integrate<N>(h, kept, out.t);
    out.done = w.v * h + h * h * (1.0 - wide_late_share<N>(kept.g_b));
}

}  // namespace
namespace {

// Impacts that are solved together.
constexpr int kPool = 128;

// From this tolerance on, lanes solve stretches of 4 nodes faster than stretches of 8: 4 nodes need shorter
// stretches, but a sweep of 8 nodes costs more than twice as much, and its values do not fit into the
// registers.
constexpr double kLooseWide = 1e-7;

// Impacts in canonical form, and their results.
struct HardPool {
    double x[kPool], z[kPool], a[kPool], b[kPool], mu_b[kPool], mu_s[kPool], e_b[kPool];
    double p[kPool], xi[kPool], zeta[kPool], g_a[kPool], g_b[kPool], sweeps[kPool];
    bool from_rest[kPool], solved[kPool];
    // The first stretch of each, as chosen by plan().
    double S[kPool], shortest[kPool], end[kPool], asked[kPool], root_s[kPool];
    bool last[kPool], vanished[kPool];
};

CAROM_INLINE Problem problem_of(const HardPool& pool, int i, double tolerance, ClothSlip cloth_slip) {
    const bool published = cloth_slip == ClothSlip::kAsPublished;
    Problem problem;
    problem.model = {pool.mu_b[i], pool.mu_s[i], published ? 2.5 : -2.5, published ? -1.5 : 3.5, pool.e_b[i]};
    problem.start = {pool.x[i], pool.z[i], pool.a[i], pool.b[i], -1.0};
    problem.tolerance = tolerance;
    problem.from_rest = pool.from_rest[i];
    return problem;
}

// The impacts in progress, one per lane: Adaptive in lanes.
struct WideRuns {
    WideModel m;
    WideStart at;
    Wide v, p, xi, zeta, g_a, g_b;
    Wide S, shortest, compressed, left, shrink, sweeps, stretches;
    Wide end, asked, root_s;
    WideMask compressing, from_rest, last;
    WideMask busy;  // lanes with an impact
};

// The scalar forms below and the lanes choose alike, also for NaN.
CAROM_INLINE Wide wide_smallest(Wide a, Wide b) {
    return select(a < b, a, b);
}

CAROM_INLINE Wide wide_largest(Wide a, Wide b) {
    return select(a > b, a, b);
}

// As plan(), operation by operation; returns the lanes whose slip has almost vanished.
CAROM_INLINE WideMask wide_plan(WideRuns& r, double tolerance) {
    const WideModel& m = r.m;
    const Wide zero = {}, one = broadcast<kWidth>(1.0);
    const Wide root = square_root(r.v * r.v + 4.0 * r.left);
    r.end = select(r.compressing, -0.5 * r.v, 2.0 * r.left / (r.v + root));
    const Wide total_left = select(r.compressing, r.end * (1.0 + m.e_b), r.end);
    const Wide ss = r.at.x * r.at.x + r.at.z * r.at.z, s = square_root(ss);
    r.root_s = inverse_root(ss);
    const Wide uu = r.at.a * r.at.a + r.at.b * r.at.b, u = square_root(uu);
    const WideMask surely_sticks = total_left * m.mu_b * 2.0 > s;
    const Wide vanished2 = select(surely_sticks, tolerance * m.mu_b * wide_smallest(u, one), zero);
    const WideMask vanished = (ss <= vanished2) | (s <= 0.25 * tolerance);
    const Wide fall = (7.0 * (r.at.x * r.at.x) + 5.0 * (r.at.z * r.at.z)) + (2.7 * m.mu_s) * (r.at.z * s);
    const Wide by_slip = 4.0 * (s * ss) / ((m.mu_b * (r.S + 2.0)) * fall);
    const Wide drag = (m.kappa * (m.mu_s * m.mu_b)) * r.at.z, su = s * u;
    const Wide fx = (m.mu_b * r.at.x) * u - drag * r.at.a,
               fy = su - ((m.sigma * m.mu_b) * r.at.z) * u - drag * r.at.b, f2 = fx * fx + fy * fy;
    const Wide beside = su * (r.S * (u * square_root(f2)) + 2.0 * (r.at.a * fx + r.at.b * fy));
    const Wide by_cloth = select(f2 > 0.0, beside / (f2 * (0.25 * r.S * r.S - 1.0)), zero);
    Wide h = select(r.from_rest, by_slip, wide_smallest(by_slip, by_cloth));
    h = wide_largest(r.shrink * wide_smallest(h, 1.25 * r.end), r.shortest);
    r.last = h >= 1.1 * r.end;
    r.asked = select(r.last, r.end, wide_smallest(h, 0.6 * r.end));
    return vanished;
}

// As add_stretch() and advance(), for the lanes that converged and for those that can be shortened. Returns
// the finished lanes; `frozen` are those that neither converged nor can be shortened, and are unchanged.
CAROM_INLINE WideMask wide_advance(WideRuns& r, const WideStretchResult& result, WideMask& frozen) {
    const WideModel& m = r.m;
    const WideResult& t = result.t;
    const Wide zero = {};
    const WideMask ok = r.busy & t.converged, failed = r.busy & ~t.converged;
    const WideMask shorter = failed & (r.asked > r.shortest);
    frozen = failed & ~shorter;
    r.sweeps += select(r.busy, t.sweeps, zero);
    const Wide raised = 1.6 * r.shrink, one = broadcast<kWidth>(1.0);
    r.shrink = select(ok, wide_smallest(one, raised), select(shorter, 0.4 * r.shrink, r.shrink));
    r.at.x = select(ok, r.at.x + (t.g_a - 7.0 * t.xi), r.at.x);
    r.at.z = select(ok, r.at.z + (2.5 * t.g_b - 5.0 * t.zeta), r.at.z);
    r.at.a = select(ok, r.at.a + (t.xi - m.kappa * t.g_a), r.at.a);
    r.at.b = select(ok, r.at.b + (t.p - (m.sigma * t.zeta + m.kappa * t.g_b)), r.at.b);
    r.v = select(ok, r.v + (2.0 * t.p - t.g_b), r.v);
    r.p += select(ok, t.p, zero);
    r.xi += select(ok, t.xi, zero);
    r.zeta += select(ok, t.zeta, zero);
    r.g_a += select(ok, t.g_a, zero);
    r.g_b += select(ok, t.g_b, zero);
    const WideMask compressing = ok & r.compressing, restoring = ok & ~r.compressing;
    r.compressed = select(compressing, r.compressed - result.done, r.compressed);
    r.left = select(restoring, r.left - result.done, r.left);
    const WideMask turns = compressing & ((r.v >= 0.0) | r.last);
    r.compressing &= ~turns;
    r.left = select(turns, m.e_b * m.e_b * r.compressed, r.left);
    r.v = select(turns, zero, r.v);
    const WideMask ends = restoring & (~(r.left > 0.0) | r.last);
    const WideMask through = ends | (turns & ~(r.left > 0.0));
    r.left = select(ends, zero, r.left);
    r.stretches += select(r.busy & ~through, one, zero);
    return through;
}

// Converts one lane to a separate impact, and back.
inline Adaptive run_of(const WideRuns& r, int i, double tolerance) {
    Adaptive run;
    run.m = {lane(r.m.mu_b, i), lane(r.m.mu_s, i), r.m.sigma, r.m.kappa, lane(r.m.e_b, i)};
    run.tolerance = tolerance;
    run.S = lane(r.S, i);
    run.shortest = lane(r.shortest, i);
    run.at = {lane(r.at.x, i), lane(r.at.z, i), lane(r.at.a, i), lane(r.at.b, i), lane(r.v, i)};
    run.total = {lane(r.p, i), lane(r.xi, i), lane(r.zeta, i), lane(r.g_a, i), lane(r.g_b, i)};
    run.compressed = lane(r.compressed, i);
    run.left = lane(r.left, i);
    run.shrink = lane(r.shrink, i);
    run.compressing = lane(r.compressing, i) != 0;
    run.from_rest = lane(r.from_rest, i) != 0;
    run.sweeps = static_cast<int>(lane(r.sweeps, i));
    run.stretches = static_cast<int>(lane(r.stretches, i));
    run.end = lane(r.end, i);
    run.asked = lane(r.asked, i);
    run.root_s = lane(r.root_s, i);
    run.last = lane(r.last, i) != 0;
    return run;
}

inline void set_run(WideRuns& r, int i, const Adaptive& run) {
    set_lane(r.m.mu_b, i, run.m.mu_b);
    set_lane(r.m.mu_s, i, run.m.mu_s);
    set_lane(r.m.e_b, i, run.m.e_b);
    set_lane(r.S, i, run.S);
    set_lane(r.shortest, i, run.shortest);
    set_lane(r.at.x, i, run.at.x);
    set_lane(r.at.z, i, run.at.z);
    set_lane(r.at.a, i, run.at.a);
    set_lane(r.at.b, i, run.at.b);
    set_lane(r.v, i, run.at.v);
    set_lane(r.p, i, run.total.p);
    set_lane(r.xi, i, run.total.xi);
    set_lane(r.zeta, i, run.total.zeta);
    set_lane(r.g_a, i, run.total.g_a);
    set_lane(r.g_b, i, run.total.g_b);
    set_lane(r.compressed, i, run.compressed);
    set_lane(r.left, i, run.left);
    set_lane(r.shrink, i, run.shrink);
    set_lane(r.sweeps, i, static_cast<double>(run.sweeps));
    set_lane(r.stretches, i, static_cast<double>(run.stretches));
    set_lane(r.end, i, run.end);
    set_lane(r.asked, i, run.asked);
    set_lane(r.root_s, i, run.root_s);
    set_lane(r.compressing, i, run.compressing ? -1 : 0);
    set_lane(r.from_rest, i, run.from_rest ? -1 : 0);
    set_lane(r.last, i, run.last ? -1 : 0);
}

CAROM_INLINE void keep_result(const Adaptive& run, int i, HardPool& pool) {
    pool.p[i] = run.total.p;
    pool.xi[i] = run.total.xi;
    pool.zeta[i] = run.total.zeta;
    pool.g_a[i] = run.total.g_a;
    pool.g_b[i] = run.total.g_b;
    pool.sweeps[i] = run.sweeps;
    pool.solved[i] = run.stretches < kMostStretches;
}

// Solves the first `count` impacts of a pool.
template <int N>
class StretchLanes {
  public:
    StretchLanes(int impacts, double asked_tolerance, ClothSlip slip, HardPool& impacts_and_results)
        : count(impacts), tolerance(asked_tolerance), cloth_slip(slip), pool(impacts_and_results) {
        r.m.sigma = cloth_slip == ClothSlip::kAsPublished ? 2.5 : -2.5;
        r.m.kappa = cloth_slip == ClothSlip::kAsPublished ? -1.5 : 3.5;
    }

    void solve() {
        for (int first = 0; first < count; first += kWidth) plan_first(first);
        for (int i = 0; i < kWidth; ++i) begin(i);
        WideStretchResult result;
        while (any(r.busy)) {
            const WideStretch w = {r.m,
                                   r.at,
                                   r.v,
                                   r.asked,
                                   r.left,
                                   r.root_s,
                                   r.busy & r.last & r.compressing,
                                   r.busy & r.last & ~r.compressing,
                                   r.shrink < 1.0,
                                   r.busy,
                                   tolerance};
            wide_stretch<N>(w, result);
            WideMask frozen;
            WideMask ended = wide_advance(r, result, frozen);
            if (any(frozen)) [[unlikely]]
                ended |= freeze(frozen);
            const WideMask goes_on = r.busy & ~ended;
            const WideMask stops = (wide_plan(r, tolerance) | ~(r.stretches < kMostStretches)) & goes_on;
            const int through = bits(ended), stopped = bits(stops);
            if ((through | stopped) == 0) continue;
            for (int i = 0; i < kWidth; ++i) {
                if (((through | stopped) >> i & 1) == 0) continue;
                Adaptive run = run_of(r, i, tolerance);
                // The scalar form ends the slip, if that is why the lane stops.
                if ((stopped >> i & 1) != 0 && run.stretches < kMostStretches) plan(run);
                end(i, run);
                begin(i);
            }
        }
    }

  private:
    WideRuns r = {};
    const int count;
    const double tolerance;
    const ClothSlip cloth_slip;
    HardPool& pool;
    int impact[kWidth];
    int next = 0;

    void end(int i, Adaptive& run) {
        finish(run);
        keep_result(run, impact[i], pool);
    }

    // Plans the first stretch of a register of impacts, starting at `first`.
    void plan_first(int first) {
        WideRuns q = {};
        q.m = r.m;
        q.m.mu_b = load<kWidth>(pool.mu_b + first);
        q.m.mu_s = load<kWidth>(pool.mu_s + first);
        q.m.e_b = load<kWidth>(pool.e_b + first);
        q.at = {load<kWidth>(pool.x + first), load<kWidth>(pool.z + first), load<kWidth>(pool.a + first),
                load<kWidth>(pool.b + first)};
        q.v = broadcast<kWidth>(-1.0);
        q.shrink = broadcast<kWidth>(1.0);
        q.shortest = 1e-3 * tolerance / q.m.mu_b;
        q.compressing = ~WideMask{};
        for (int i = 0; i < kWidth; ++i) {
            set_lane(q.S, i, needed_axes<N>(0.3 * pool.mu_b[first + i] / tolerance));
            set_lane(q.from_rest, i, pool.from_rest[first + i] ? -1 : 0);
        }
        const WideMask vanished = wide_plan(q, tolerance);
        store(pool.S + first, q.S);
        store(pool.shortest + first, q.shortest);
        store(pool.end + first, q.end);
        store(pool.asked + first, q.asked);
        store(pool.root_s + first, q.root_s);
        for (int i = 0; i < kWidth; ++i) {
            pool.last[first + i] = lane(q.last, i) != 0;
            pool.vanished[first + i] = lane(vanished, i) != 0;
        }
    }

    // Begins impacts in lane i until one has a stretch to solve or none is left.
    void begin(int i) {
        for (; next < count; ++next) {
            const int k = next;
            impact[i] = k;
            if (pool.vanished[k]) {
                Adaptive run;
                begin_adaptive<N>(problem_of(pool, k, tolerance, cloth_slip), run);
                plan(run);
                end(i, run);
                continue;
            }
            ++next;
            set_lane(r.m.mu_b, i, pool.mu_b[k]);
            set_lane(r.m.mu_s, i, pool.mu_s[k]);
            set_lane(r.m.e_b, i, pool.e_b[k]);
            set_lane(r.S, i, pool.S[k]);
            set_lane(r.shortest, i, pool.shortest[k]);
            set_lane(r.at.x, i, pool.x[k]);
            set_lane(r.at.z, i, pool.z[k]);
            set_lane(r.at.a, i, pool.a[k]);
            set_lane(r.at.b, i, pool.b[k]);
            set_lane(r.v, i, -1.0);
            set_lane(r.p, i, 0.0);
            set_lane(r.xi, i, 0.0);
            set_lane(r.zeta, i, 0.0);
            set_lane(r.g_a, i, 0.0);
            set_lane(r.g_b, i, 0.0);
            set_lane(r.compressed, i, 0.0);
            set_lane(r.left, i, 0.0);
            set_lane(r.sweeps, i, 0.0);
            set_lane(r.stretches, i, 0.0);
            set_lane(r.shrink, i, 1.0);
            set_lane(r.end, i, pool.end[k]);
            set_lane(r.asked, i, pool.asked[k]);
            set_lane(r.root_s, i, pool.root_s[k]);
            set_lane(r.compressing, i, -1);
            set_lane(r.from_rest, i, pool.from_rest[k] ? -1 : 0);
            set_lane(r.last, i, pool.last[k] ? -1 : 0);
            set_lane(r.busy, i, -1);
            return;
        }
        set_lane(r.busy, i, 0);
    }

    // Accepts steps that are too short to be shortened. Returns the lanes that are then finished.
    WideMask freeze(WideMask lanes) {
        WideMask through = {};
        for (int i = 0; i < kWidth; ++i) {
            if (lane(lanes, i) == 0) continue;
            Adaptive run = run_of(r, i, tolerance);
            --run.stretches;  // wide_advance() has counted this one
            if (advance(run, false, run.at, run.total, 0.0))
                ++run.stretches;
            else
                set_lane(through, i, -1);
            set_run(r, i, run);
        }
        return through;
    }
};

template <int N>
inline void run_stretches(int count, double tolerance, ClothSlip cloth_slip, HardPool& pool) {
    StretchLanes<N>(count, tolerance, cloth_slip, pool).solve();
}

}  // namespace
}  // namespace carom::kernel
