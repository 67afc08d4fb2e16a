// Batches by tolerance: easy impacts in lanes, harder ones compacted into lanes of 8 nodes, those that need
// stretches in lanes that take up the next impact as soon as one is through; special cases one at a time. Built
// once per instruction set, together with the single kernel; CAROM_TOLERANCE_BATCH_NAME is the function's name.
#pragma once

#include "tolerance/batch_lanes.h"
#include "tolerance/batch_pool.h"

namespace carom::kernel {
namespace {

constexpr long kChunk = 256;
constexpr int kMostHard = 256;  // impacts that need stretches are solved once so many have come together

// Lane i of a batch by the single kernel.
inline void solve_single(const BatchView& v, long i, double tolerance) {
    Ball ball1, ball2;
    for (int k = 0; k < 3; ++k) {
        ball1.r[k] = v.in[kR1 + k][i];
        ball1.v[k] = v.in[kV1 + k][i];
        ball1.w[k] = v.in[kW1 + k][i];
        ball2.r[k] = v.in[kR2 + k][i];
        ball2.v[k] = v.in[kV2 + k][i];
        ball2.w[k] = v.in[kW2 + k][i];
    }
    const ImpactParams params = {v.in[kRadius][i], v.in[kMass][i], v.in[kMuS1][i], v.in[kMuS2][i],
                                 v.in[kMuB][i],    v.in[kEB][i],   v.cloth_slip};
    ImpactResult result;
    solve_impact(ball1, ball2, params, tolerance, result);
    for (int k = 0; k < 3; ++k) {
        v.out[k][i] = result.v1[k];
        v.out[3 + k][i] = result.w1[k];
        v.out[6 + k][i] = result.v2[k];
        v.out[9 + k][i] = result.w2[k];
    }
    v.status[i] = result.status;
    if (v.steps != nullptr) v.steps[i] = result.steps;
    if (v.method != nullptr) v.method[i] = result.method;
}

// What is left to do. Whole registers of impacts for 8 nodes are solved chunk by chunk, the others wait for
// more of their kind.
struct Remaining {
    long resolvable[kChunk + kWidth], hard[kMostHard + kChunk + kWidth];
    int resolvables, hards;
};

// Four nodes over the lanes [begin, end).
inline void sweep_easy(const BatchView& v, long begin, long end, double tolerance, Remaining& rest) {
    Wide in[kInputs];
    BlockResult block;
    for (long i = begin; i < end; i += kWidth) {
        const int lanes = static_cast<int>(end - i < kWidth ? end - i : kWidth);
        if (lanes == kWidth) {
            for (int k = 0; k < kInputs; ++k) in[k] = wide_load(v.in[k] + i);
        } else {
            long index[kWidth] = {};
            for (int lane = 0; lane < lanes; ++lane) index[lane] = i + lane;
            gather(v, index, lanes, in);
        }
        solve_block<4>(in, v.cloth_slip, tolerance, block);
        if (lanes == kWidth) {  // lanes without a result are written again later
            for (int k = 0; k < kOutputs; ++k) wide_store(v.out[k] + i, block.out[k]);
            for (int lane = 0; lane < kWidth; ++lane) v.status[i + lane] = ImpactStatus::kOk;
            if (v.steps != nullptr) {
                for (int lane = 0; lane < kWidth; ++lane)
                    v.steps[i + lane] = static_cast<long>(block.sweeps[lane]);
            }
            if (v.method != nullptr) {
                for (int lane = 0; lane < kWidth; ++lane) v.method[i + lane] = ToleranceMethod::kCollocation4;
            }
            if (!any(~block.done)) continue;
        }
        for (int lane = 0; lane < lanes; ++lane) {
            if (block.done[lane] != 0) {
                if (lanes < kWidth) write_lane(v, block, lane, i + lane, ToleranceMethod::kCollocation4);
            } else if (block.good[lane] == 0) {
                solve_single(v, i + lane, tolerance);
            } else if (block.resolvable[lane] != 0) {
                rest.resolvable[rest.resolvables++] = i + lane;
            } else {
                rest.hard[rest.hards++] = i + lane;
            }
        }
    }
}

// Eight nodes over compacted lanes; those that do not fill a register stay, unless `all` are wanted.
inline void sweep_resolvable(const BatchView& v, double tolerance, bool all, Remaining& rest) {
    Wide in[kInputs];
    BlockResult block;
    int first = 0;
    for (; rest.resolvables - first >= (all ? 1 : kWidth); first += kWidth) {
        const int lanes = rest.resolvables - first < kWidth ? rest.resolvables - first : kWidth;
        const long* index = rest.resolvable + first;
        gather(v, index, lanes, in);
        solve_block<8>(in, v.cloth_slip, tolerance, block);
        for (int lane = 0; lane < lanes; ++lane) {
            if (block.done[lane] != 0)
                write_lane(v, block, lane, index[lane], ToleranceMethod::kCollocation8);
            else
                rest.hard[rest.hards++] = index[lane];
        }
    }
    const int left = rest.resolvables > first ? rest.resolvables - first : 0;
    for (int k = 0; k < left; ++k) rest.resolvable[k] = rest.resolvable[first + k];
    rest.resolvables = left;
}

// The impacts that no single collocation solves.
inline void sweep_hard(const BatchView& v, double tolerance, Remaining& rest) {
    Wide in[kInputs];
    WidePose q;
    HardPool pool;
    for (int first = 0; first < rest.hards; first += kPool) {
        const int count = rest.hards - first < kPool ? rest.hards - first : kPool;
        const long* index = rest.hard + first;
        for (int i = 0; i < count; i += kWidth) {
            gather(v, index + i, count - i, in);
            wide_pose(in, v.cloth_slip, tolerance, q);
            wide_store(pool.x + i, q.start.x);
            wide_store(pool.z + i, q.start.z);
            wide_store(pool.a + i, q.start.a);
            wide_store(pool.b + i, q.start.b);
            wide_store(pool.mu_b + i, q.m.mu_b);
            wide_store(pool.mu_s + i, q.m.mu_s);
            wide_store(pool.e_b + i, q.m.e_b);
            for (int lane = 0; lane < kWidth; ++lane) pool.from_rest[i + lane] = q.from_rest[lane] != 0;
        }
        if (tolerance >= kLooseWide)
            run_stretches<4>(count, tolerance, v.cloth_slip, pool);
        else
            run_stretches<8>(count, tolerance, v.cloth_slip, pool);
        for (int i = 0; i < count; i += kWidth) {
            const int lanes = count - i < kWidth ? count - i : kWidth;
            gather(v, index + i, lanes, in);
            wide_pose(in, v.cloth_slip, tolerance, q);
            WideResult t;
            t.p = wide_load(pool.p + i);
            t.xi = wide_load(pool.xi + i);
            t.zeta = wide_load(pool.zeta + i);
            t.g_a = wide_load(pool.g_a + i);
            t.g_b = wide_load(pool.g_b + i);
            BlockResult block;
            wide_apply(in, q, t, block);
            block.sweeps = wide_load(pool.sweeps + i);
            for (int lane = 0; lane < lanes; ++lane) {
                if (pool.solved[i + lane])
                    write_lane(v, block, lane, index[i + lane], ToleranceMethod::kAdaptive);
                else
                    solve_single(v, index[i + lane], tolerance);
            }
        }
    }
    rest.hards = 0;
}

}  // namespace

void CAROM_TOLERANCE_BATCH_NAME(const ImpactBatch& batch, double tolerance,
                                const ImpactBatchResult& result) noexcept {
    const BatchView v = view(batch, result);
    if (!(tolerance >= kTightestTolerance && tolerance <= kLoosestTolerance)) {
        // The single kernel says what is wrong.
        for (long i = 0; i < batch.count; ++i) solve_single(v, i, tolerance);
        return;
    }
    const double solved = smallest(tolerance, kLoosestSolved);
    Remaining rest;
    rest.resolvables = rest.hards = 0;
    for (long begin = 0; begin < batch.count; begin += kChunk) {
        const bool last = batch.count - begin <= kChunk;
        sweep_easy(v, begin, last ? batch.count : begin + kChunk, solved, rest);
        sweep_resolvable(v, solved, last, rest);
        if (last || rest.hards >= kMostHard) sweep_hard(v, solved, rest);
    }
}

}  // namespace carom::kernel
