// Impacts solved to a tolerance, single and in batches. Built once per instruction set.
//
// A batch solves its easy impacts in lanes in their order, by one collocation of 4 nodes. Impacts that need 8
// nodes are collected until they fill a register. Impacts that need stretches are collected too, and each
// lane starts the next one as soon as it has finished one. Special cases are left to the single kernel.
#include <cstdint>

#include "kernel_set.h"
#include "tolerance/batch_lanes.h"
#include "tolerance/batch_pool.h"

namespace carom::kernel {
namespace {

// Impacts between two checks of the collected ones.
constexpr std::int64_t kChunk = 256;
// Impacts that need 8 nodes, and those that need stretches, are solved once this many are collected.
constexpr int kMostResolvable = 256, kMostHard = 256;

// Solves lane i of a batch with the single kernel.
inline void solve_single(const BatchView& v, std::int64_t i, double tolerance) {
    Ball ball1, ball2;
    for (int k = 0; k < 3; ++k) {
        ball1.r[k] = v.in[kR1 + k][i];
        ball1.v[k] = v.in[kV1 + k][i];
        ball1.w[k] = v.in[kW1 + k][i];
        ball2.r[k] = v.in[kR2 + k][i];
        ball2.v[k] = v.in[kV2 + k][i];
        ball2.w[k] = v.in[kW2 + k][i];
    }
    const ImpactParams params = {v.in[kRadius][i],
                                 v.in[kMass][i],
                                 v.in[kMuS1][i],
                                 v.in[kMuS2][i],
                                 v.in[kMuB][i],
                                 v.in[kEB][i],
                                 v.cloth_slip,
                                 v.mass_ratio == nullptr ? 1.0 : v.mass_ratio[i],
                                 v.radius_ratio == nullptr ? 1.0 : v.radius_ratio[i]};
    ImpactResult result;
    solve_impact(ball1, ball2, params, tolerance, result);
    for (int k = 0; k < 3; ++k) {
        v.out[kOutV1 + k][i] = result.v1[k];
        v.out[kOutW1 + k][i] = result.w1[k];
        v.out[kOutV2 + k][i] = result.v2[k];
        v.out[kOutW2 + k][i] = result.w2[k];
    }
    v.status[i] = result.status;
    if (v.steps != nullptr) v.steps[i] = result.steps;
    if (v.method != nullptr) v.method[i] = result.method;
}

// The remaining impacts: those that one collocation of 8 nodes may solve, and those that need stretches.
struct Remaining {
    std::int64_t resolvable[kMostResolvable + kChunk], hard[kMostHard + kMostResolvable + kChunk];
    double hardness[kMostResolvable + kChunk];  // of the resolvable
    int resolvables, hards;
};

// Sorts the resolvable impacts roughly by the expected number of sweeps, because all lanes of a register wait
// for the slowest.
inline void sort_resolvable(Remaining& rest) {
    constexpr int kBins = 32;
    const auto bin = [&](int i) {
        const double b = kBins * rest.hardness[i];
        return b < kBins - 1 ? static_cast<int>(b) : kBins - 1;
    };
    int end[kBins] = {};
    for (int i = 0; i < rest.resolvables; ++i) ++end[bin(i)];
    for (int b = 1; b < kBins; ++b) end[b] += end[b - 1];
    std::int64_t index[kMostResolvable + kChunk];
    double hardness[kMostResolvable + kChunk];
    for (int i = rest.resolvables - 1; i >= 0; --i) {
        const int to = --end[bin(i)];
        index[to] = rest.resolvable[i];
        hardness[to] = rest.hardness[i];
    }
    for (int i = 0; i < rest.resolvables; ++i) {
        rest.resolvable[i] = index[i];
        rest.hardness[i] = hardness[i];
    }
}

// Solves the impacts [begin, end) with 4 nodes.
inline void sweep_easy(const BatchView& v, std::int64_t begin, std::int64_t end, double tolerance,
                       Remaining& rest) {
    Wide in[kInputs];
    BlockResult block;
    const bool unlike = v.mass_ratio != nullptr || v.radius_ratio != nullptr;
    for (std::int64_t i = begin; i < end; i += kWidth) {
        const int lanes = static_cast<int>(end - i < kWidth ? end - i : kWidth);
        if (lanes == kWidth) {
            for (int k = 0; k < kInputs; ++k) in[k] = load<kWidth>(v.in[k] + i);
        } else {
            std::int64_t index[kWidth] = {};
            for (int j = 0; j < lanes; ++j) index[j] = i + j;
            gather(v, index, lanes, in);
        }
        solve_block<4>(in, v.cloth_slip, tolerance, block);
        if (lanes == kWidth) {  // unsolved lanes are overwritten later
            for (int k = 0; k < kOutputs; ++k) store(v.out[k] + i, block.out[k]);
            for (int j = 0; j < kWidth; ++j) v.status[i + j] = ImpactStatus::kOk;
            if (v.steps != nullptr) {
                for (int j = 0; j < kWidth; ++j)
                    v.steps[i + j] = static_cast<std::int64_t>(lane(block.sweeps, j));
            }
            if (v.method != nullptr) {
                for (int j = 0; j < kWidth; ++j) v.method[i + j] = ToleranceMethod::kCollocation4;
            }
            if (!unlike && !any(~block.done)) continue;
        }
        for (int j = 0; j < lanes; ++j) {
            if (unlike && !v.alike(i + j)) {
                solve_single(v, i + j, tolerance);
            } else if (lane(block.done, j) != 0) {
                if (lanes < kWidth) write_lane(v, block, j, i + j, ToleranceMethod::kCollocation4);
            } else if (lane(block.good, j) == 0) {
                solve_single(v, i + j, tolerance);
            } else if (lane(block.resolvable, j) != 0 && tolerance < kLooseStretches) {
                rest.hardness[rest.resolvables] = lane(block.hardness, j);
                rest.resolvable[rest.resolvables++] = i + j;
            } else {
                rest.hard[rest.hards++] = i + j;
            }
        }
    }
}

// Solves the collected impacts with 8 nodes.
inline void sweep_resolvable(const BatchView& v, double tolerance, Remaining& rest) {
    Wide in[kInputs];
    BlockResult block;
    sort_resolvable(rest);
    for (int first = 0; first < rest.resolvables; first += kWidth) {
        const int lanes = rest.resolvables - first < kWidth ? rest.resolvables - first : kWidth;
        const std::int64_t* index = rest.resolvable + first;
        gather(v, index, lanes, in);
        solve_block<8>(in, v.cloth_slip, tolerance, block);
        for (int j = 0; j < lanes; ++j) {
            if (lane(block.done, j) != 0)
                write_lane(v, block, j, index[j], ToleranceMethod::kCollocation8);
            else
                rest.hard[rest.hards++] = index[j];
        }
    }
    rest.resolvables = 0;
}

// Solves the collected impacts that no single collocation solves.
inline void sweep_hard(const BatchView& v, double tolerance, Remaining& rest) {
    Wide in[kInputs];
    WidePose q;
    HardPool pool;
    for (int first = 0; first < rest.hards; first += kPool) {
        const int count = rest.hards - first < kPool ? rest.hards - first : kPool;
        const std::int64_t* index = rest.hard + first;
        for (int i = 0; i < count; i += kWidth) {
            gather(v, index + i, count - i, in);
            wide_pose(in, v.cloth_slip, tolerance, q);
            store(pool.x + i, q.start.x);
            store(pool.z + i, q.start.z);
            store(pool.a + i, q.start.a);
            store(pool.b + i, q.start.b);
            store(pool.mu_b + i, q.m.mu_b);
            store(pool.mu_s + i, q.m.mu_s);
            store(pool.e_b + i, q.m.e_b);
            for (int j = 0; j < kWidth; ++j) pool.from_rest[i + j] = lane(q.from_rest, j) != 0;
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
            t.p = load<kWidth>(pool.p + i);
            t.xi = load<kWidth>(pool.xi + i);
            t.zeta = load<kWidth>(pool.zeta + i);
            t.g_a = load<kWidth>(pool.g_a + i);
            t.g_b = load<kWidth>(pool.g_b + i);
            BlockResult block;
            wide_apply(in, q, t, block);
            block.sweeps = load<kWidth>(pool.sweeps + i);
            for (int j = 0; j < lanes; ++j) {
                if (pool.solved[i + j])
                    write_lane(v, block, j, index[i + j], ToleranceMethod::kAdaptive);
                else
                    solve_single(v, index[i + j], tolerance);
            }
        }
    }
    rest.hards = 0;
}

}  // namespace

namespace CAROM_ISA_NAMESPACE {

void tolerance_single(const Ball& ball1, const Ball& ball2, const ImpactParams& params, double tolerance,
                      ImpactResult& result) noexcept {
    solve_impact(ball1, ball2, params, tolerance, result);
}

void tolerance_batch(const ImpactBatch& batch, double tolerance, const ImpactBatchResult& result) noexcept {
    const BatchView v = view(batch, result);
    if (!(tolerance >= kTightestTolerance && tolerance <= kLoosestTolerance)) {
        // The single kernel reports the fault.
        for (std::int64_t i = 0; i < batch.count; ++i) solve_single(v, i, tolerance);
        return;
    }
    const double solved = smallest(tolerance, kLoosestSolved);
    Remaining rest;
    rest.resolvables = rest.hards = 0;
    for (std::int64_t begin = 0; begin < batch.count; begin += kChunk) {
        const bool last = batch.count - begin <= kChunk;
        sweep_easy(v, begin, last ? batch.count : begin + kChunk, solved, rest);
        if (last || rest.resolvables >= kMostResolvable) sweep_resolvable(v, solved, rest);
        if (last || rest.hards >= kMostHard) sweep_hard(v, solved, rest);
    }
}

}  // namespace CAROM_ISA_NAMESPACE

}  // namespace carom::kernel
