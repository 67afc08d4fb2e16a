// One stretch of many impacts, as collocate() for one impact. Symbols: collocation.h. As in wide.h, a lane
// reads only its own numbers.
#pragma once

#include "tolerance/wide.h"

namespace carom::kernel {
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
}  // namespace carom::kernel
