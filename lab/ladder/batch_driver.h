// Marches a batch in lanes. W * U lanes are filled and marched without a stop test while none can end, then
// step by step; each lane is removed when it ends. Lanes far longer than the others finish alone, so that one
// long impact does not delay the rest.
#pragma once

#include "ladder/lanes.h"
#include "loop_marks.h"

namespace carom::kernel {
namespace {

template <int W, int U, class Roots, class Arithmetic, int kSign>
class BatchMarch {
  public:
    BatchMarch(const ImpactBatch& b, int substeps, const ImpactBatchResult& r)
        : batch(b), n(substeps), result(r) {}

    void run() {
        const long count = batch.count;
        for (long i = 0; i < count; ++i) fill(i);
        for (Group& g : groups) march(g);
    }

  private:
    using V = Pack<W>;
    struct Group {
        Lanes<W> lanes[U];
        LaneRecord records[W * U];
        int filled = 0;
    };

    const ImpactBatch& batch;
    const int n;
    const ImpactBatchResult& result;
    // Impacts that stick, or nearly stick, need the slow root path from then on. They share vectors only with
    // each other.
    Group groups[2] = {};

    static Lanes<W>& lanes_of(Group& g, int i) { return g.lanes[i / W]; }

    void fill(long index) {
        LaneRecord r{};
        if (!enter_impact(batch, index, n, r, result)) return;
        r.k = reduced_constants<kSign>(r.state, r.params, n);
        r.active = r.compressing = true;
        r.start = reduce<kSign>(r.state, r.params.R);
        const double c = square_root(r.start.x * r.start.x + r.start.z * r.start.z);
        Group& g = groups[c < 8.0 * r.k.mu_h * n];
        const int lane = g.filled++;
        g.records[lane] = r;
        fill_lane<W>(lanes_of(g, lane), lane % W, r);
        if (g.filled == W * U) march(g);
    }

    // The sum of (v(m) + v(m+1)) / 2 over the completed steps.
    double work_sum(Group& g, int i) {
        Lanes<W>& s = lanes_of(g, i);
        return s.sum_v[i % W] + 0.5 * (s.v_n[i % W] - g.records[i].start.v_n);
    }

    // Number of steps within which lane i cannot end or change from compression to restitution. In a step v_n
    // grows by at most (2 + mu_s mu_b) h.
    long safe_steps(Group& g, int i) {
        const LaneRecord& r = g.records[i];
        const double v = lanes_of(g, i).v_n[i % W], h = r.k.h;
        const double mu_s = r.k.mu_s[0] > r.k.mu_s[1] ? r.k.mu_s[0] : r.k.mu_s[1];
        const double growth = 2.0 * h + mu_s * r.k.mu_h;
        double steps = -v / growth;
        if (!r.compressing) {
            const double missing = r.W_f - r.W - (work_sum(g, i) - r.V_cross);
            // The solution s of missing = v s + growth s^2 / 2.
            steps = missing > 0.0 ? (square_root(v * v + 2.0 * growth * missing) - v) / growth : 0.0;
        }
        return steps < 3.0 ? 0 : steps < 1e9 ? static_cast<long>(steps) - 2 : 1000000000L;
    }

    void march(Group& g) {
        const int filled = g.filled;
        long done = 0, alive = filled;
        const long patience = static_cast<long>(n) + n / 8 + 64;
        while (alive > 0) {
            long safe = 1000000000L;
            for (int i = 0; i < filled; ++i) {
                if (!g.records[i].active) continue;
                const long steps = safe_steps(g, i);
                if (steps < safe) safe = steps;
            }
            if (safe > patience) safe = patience;
            advance(g, safe);
            done += safe;
            const long careful = 8;
            for (long m = 0; m < careful && alive > 0; ++m) {
                double sum_before[W * U], v_before[W * U];
                for (int i = 0; i < filled; ++i) {
                    sum_before[i] = work_sum(g, i);
                    v_before[i] = lanes_of(g, i).v_n[i % W];
                }
                advance(g, 1);
                ++done;
                for (int i = 0; i < filled; ++i)
                    if (g.records[i].active) alive -= ends(g, i, sum_before[i], v_before[i], done);
            }
            if (done > patience) {
                for (int i = 0; i < filled; ++i)
                    if (g.records[i].active) finish_alone(g, i, done);
                break;
            }
        }
        g = Group{};
    }

    // The group is copied in and out, so that it stays in registers over the steps.
    void advance(Group& g, long steps) {
        Lanes<W> s[U];
        for (int u = 0; u < U; ++u) s[u] = g.lanes[u];
        for (long m = 0; m < steps; ++m) {
            CAROM_LOOP_BEGIN("lanes");
#pragma GCC unroll 4
            for (int u = 0; u < U; ++u) lane_step<W, Roots, Arithmetic, kSign>(s[u]);
            CAROM_LOOP_END("lanes");
        }
        for (int u = 0; u < U; ++u) g.lanes[u] = s[u];
    }

    // The published stop test on lane i after a step. Returns true if the lane has ended and was removed.
    bool ends(Group& g, int i, double sum_before, double v_before, long done) {
        LaneRecord& r = g.records[i];
        const double v = lanes_of(g, i).v_n[i % W];
        if (r.compressing && v > 0.0) {
            r.compressing = false;
            r.V_cross = work_sum(g, i);
            r.W = absolute(0.5 * (v_before + v)) - sum_before;
            r.W_f = r.k.work_ratio * r.W;
        }
        const double W_now = r.compressing ? 0.0 : r.W + (work_sum(g, i) - r.V_cross);
        if (v < 0.0 || r.compressing || W_now < r.W_f) return false;
        take_out(g, i, lane_state<W>(lanes_of(g, i), i % W), done);
        return true;
    }

    void take_out(Group& g, int i, const Reduced& end, long steps) {
        LaneRecord& r = g.records[i];
        expand(r.state, sums_between<kSign>(r.start, end, static_cast<double>(steps) * r.k.h), r.params.R);
        leave_impact(r, steps, result);
        r.active = false;
        Lanes<W>& s = lanes_of(g, i);
        V* const constants[5] = {&s.h, &s.h2, &s.mu_h, &s.mu_hs, &s.mu_other};
        for (V* constant : constants) (*constant)[i % W] = 0.0;
    }

    void finish_alone(Group& g, int i, long done) {
        LaneRecord& r = g.records[i];
        Reduced state = lane_state<W>(lanes_of(g, i), i % W);
        StopTest stop;
        stop.compressing = r.compressing;
        stop.W = r.k.h * (r.compressing ? -work_sum(g, i) : r.W + (work_sum(g, i) - r.V_cross));
        stop.W_f = r.k.h * r.W_f;
        reduced_steps<kSign>(state, stop, done, r.k.limit - done, r.k);
        if (stop.goes_on(state.v_n))
            leave_impact(r, -1, result);
        else
            take_out(g, i, state, done);
    }
};

template <int W, int U, class Roots, class Arithmetic>
void batch_march(const ImpactBatch& batch, int n, const ImpactBatchResult& result) noexcept {
    if (batch.params.cloth_slip == ClothSlip::kAsPublished)
        BatchMarch<W, U, Roots, Arithmetic, +1>(batch, n, result).run();
    else
        BatchMarch<W, U, Roots, Arithmetic, -1>(batch, n, result).run();
}

}  // namespace
}  // namespace carom::kernel
