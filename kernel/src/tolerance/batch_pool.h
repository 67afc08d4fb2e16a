// Impacts of a batch that are solved in stretches. Each lane starts the next impact as soon as it has finished one.
#pragma once

#include "tolerance/single.h"
#include "tolerance/wide_adaptive.h"

namespace carom::kernel {
namespace {

// Impacts that are solved in one go.
constexpr int kPool = 128;

// From this tolerance on, lanes solve stretches of 4 nodes faster than stretches of 8: they are shorter, but a sweep
// of 8 nodes costs more than twice as much and its values do not fit into the registers.
constexpr double kLooseWide = 1e-7;

// Impacts in their canonical form, and their results.
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

// Solves the first `count` impacts of the pool.
template <int N>
inline void run_stretches(int count, double tolerance, ClothSlip cloth_slip, HardPool& pool) {
    Adaptive runs[kWidth];
    int impact[kWidth];
    int next = 0;
    WideStretch w = {};
    w.m.sigma = cloth_slip == ClothSlip::kAsPublished ? 2.5 : -2.5;
    w.m.kappa = cloth_slip == ClothSlip::kAsPublished ? -1.5 : 3.5;
    w.tolerance = tolerance;
    for (int i = 0; i < kWidth; ++i) impact[i] = -1;
    WideStretchResult result;
    for (;;) {
        bool busy = false;
        for (int i = 0; i < kWidth; ++i) {
            Adaptive& run = runs[i];
            for (;;) {  // until the lane has a stretch to solve or no impact is left
                if (impact[i] < 0) {
                    if (next == count) break;
                    begin_adaptive<N>(problem_of(pool, next, tolerance, cloth_slip), run);
                    impact[i] = next++;
                    set_lane(w.m.mu_b, i, run.m.mu_b);
                    set_lane(w.m.mu_s, i, run.m.mu_s);
                }
                if (run.stretches < kMostStretches && plan(run)) break;
                finish(run);
                keep_result(run, impact[i], pool);
                impact[i] = -1;
            }
            set_lane(w.wanted, i, impact[i] < 0 ? 0 : -1);
            if (impact[i] < 0) continue;
            busy = true;
            set_lane(w.start.x, i, run.at.x);
            set_lane(w.start.z, i, run.at.z);
            set_lane(w.start.a, i, run.at.a);
            set_lane(w.start.b, i, run.at.b);
            set_lane(w.v, i, run.at.v);
            set_lane(w.h, i, run.asked);
            set_lane(w.work, i, run.left);
            set_lane(w.root_s, i, run.root_s);
            set_lane(w.to_zero, i, run.last && run.compressing ? -1 : 0);
            set_lane(w.to_work, i, run.last && !run.compressing ? -1 : 0);
            set_lane(w.exact, i, run.shrink < 1.0 ? -1 : 0);
        }
        if (!busy) break;
        wide_stretch<N>(w, result);
        for (int i = 0; i < kWidth; ++i) {
            if (impact[i] < 0) continue;
            Adaptive& run = runs[i];
            State at = run.at;
            Impulses total = run.total;
            const Impulses add = {lane(result.t.p, i), lane(result.t.xi, i), lane(result.t.zeta, i),
                                  lane(result.t.g_a, i), lane(result.t.g_b, i)};
            add_stretch(run.m, add, at, total);
            run.sweeps += static_cast<int>(lane(result.t.sweeps, i));
            if (advance(run, lane(result.t.converged, i) != 0, at, total, lane(result.done, i))) {
                ++run.stretches;
                continue;
            }
            finish(run);
            keep_result(run, impact[i], pool);
            impact[i] = -1;
        }
    }
}

}  // namespace
}  // namespace carom::kernel
