// Impacts of a batch that need stretches, posed and put side by side: each lane takes up the next as soon as
// it is through with one.
#pragma once

#include "tolerance/impl.h"
#include "tolerance/wide_adaptive.h"

namespace carom::kernel {
namespace {

constexpr int kPool = 128;  // so many at once

// Posed impacts that need stretches, and what becomes of them.
struct HardPool {
    double x[kPool], z[kPool], a[kPool], b[kPool], mu_b[kPool], mu_s[kPool], e_b[kPool];
    double p[kPool], xi[kPool], zeta[kPool], g_a[kPool], g_b[kPool], sweeps[kPool];
    bool from_rest[kPool], solved[kPool];
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

CAROM_INLINE void keep_result(const Adaptive& run, int i, HardPool& pool) {
    pool.p[i] = run.total.p;
    pool.xi[i] = run.total.xi;
    pool.zeta[i] = run.total.zeta;
    pool.g_a[i] = run.total.g_a;
    pool.g_b[i] = run.total.g_b;
    pool.sweeps[i] = run.sweeps;
    pool.solved[i] = run.stretches < kMostStretches;
}

// From this tolerance on lanes do better with stretches of 4 nodes: they are shorter, but a sweep of 8 nodes
// costs more than twice as much and spills its registers.
constexpr double kLooseWide = 1e-7;

// Impacts by stretches: a lane that is through with one takes up the next.
template <int N>
inline void run_stretches(int count, double tolerance, ClothSlip cloth_slip, HardPool& pool) {
    constexpr int K = N / 4;
    Adaptive runs[kWidth];
    int impact[kWidth];
    int next = 0;
    WideStretch w = {};
    w.m.sigma = cloth_slip == ClothSlip::kAsPublished ? 2.5 : -2.5;
    w.m.kappa = cloth_slip == ClothSlip::kAsPublished ? -1.5 : 3.5;
    w.tolerance = tolerance;
    for (int lane = 0; lane < kWidth; ++lane) impact[lane] = -1;
    WideStretchResult result;
    for (;;) {
        bool busy = false;
        for (int lane = 0; lane < kWidth; ++lane) {
            Adaptive& run = runs[lane];
            for (;;) {  // until the lane has a stretch to do or nothing is left for it
                if (impact[lane] < 0) {
                    if (next == count) break;
                    begin_adaptive<K>(problem_of(pool, next, tolerance, cloth_slip), run);
                    impact[lane] = next++;
                    w.m.mu_b[lane] = run.m.mu_b;
                    w.m.mu_s[lane] = run.m.mu_s;
                }
                if (run.stretches < kMostStretches && plan(run)) break;
                finish(run);
                keep_result(run, impact[lane], pool);
                impact[lane] = -1;
            }
            w.wanted[lane] = impact[lane] < 0 ? 0 : -1;
            if (impact[lane] < 0) continue;
            busy = true;
            w.start.x[lane] = run.at.x;
            w.start.z[lane] = run.at.z;
            w.start.a[lane] = run.at.a;
            w.start.b[lane] = run.at.b;
            w.v[lane] = run.at.v;
            w.h[lane] = run.asked;
            w.work[lane] = run.left;
            w.root_s[lane] = run.root_s;
            w.to_zero[lane] = run.last && run.compressing ? -1 : 0;
            w.to_work[lane] = run.last && !run.compressing ? -1 : 0;
            w.exact[lane] = run.shrink < 1.0 ? -1 : 0;
        }
        if (!busy) break;
        wide_stretch<N>(w, result);
        for (int lane = 0; lane < kWidth; ++lane) {
            if (impact[lane] < 0) continue;
            Adaptive& run = runs[lane];
            State at = run.at;
            Impulses total = run.total;
            const Impulses add = {result.t.p[lane], result.t.xi[lane], result.t.zeta[lane],
                                  result.t.g_a[lane], result.t.g_b[lane]};
            add_stretch(run.m, add, at, total);
            run.sweeps += static_cast<int>(result.t.sweeps[lane]);
            const bool going = advance(run, result.t.converged[lane] != 0, at, total, result.done[lane]);
            ++run.stretches;
            if (going) continue;
            --run.stretches;
            finish(run);
            keep_result(run, impact[lane], pool);
            impact[lane] = -1;
        }
    }
}

}  // namespace
}  // namespace carom::kernel
