// One impact of a batch: from the arrays into the contact frame, and its result back into the arrays.
#pragma once

#include "carom/kernel/batch.h"
#include "frame.h"

namespace carom::kernel {
namespace {

struct BatchImpact {
    Ball ball1, ball2;
    ImpactParams params;
    Frame frame;
    FrameState state;
    long index;
};

inline void store_result(const ImpactBatchResult& out, long i, const ImpactResult& result) {
    for (int k = 0; k < 3; ++k) {
        out.ball1.v[k][i] = result.v1[k];
        out.ball1.w[k][i] = result.w1[k];
        out.ball2.v[k][i] = result.v2[k];
        out.ball2.w[k][i] = result.w2[k];
    }
    out.status[i] = result.status;
    if (out.steps != nullptr) out.steps[i] = result.steps;
    if (out.method != nullptr) out.method[i] = result.method;
}

// Reads impact i. Returns false if it needs no march with n substeps; its result is then stored.
inline bool enter_impact(const ImpactBatch& batch, long i, int n, BatchImpact& in,
                         const ImpactBatchResult& out) {
    for (int k = 0; k < 3; ++k) {
        in.ball1.r[k] = batch.ball1.r[k][i];
        in.ball1.v[k] = batch.ball1.v[k][i];
        in.ball1.w[k] = batch.ball1.w[k][i];
        in.ball2.r[k] = batch.ball2.r[k][i];
        in.ball2.v[k] = batch.ball2.v[k][i];
        in.ball2.w[k] = batch.ball2.w[k][i];
    }
    in.params = {batch.params.R[i],    batch.params.m[i],   batch.params.mu_s1[i],  batch.params.mu_s2[i],
                 batch.params.mu_b[i], batch.params.e_b[i], batch.params.cloth_slip};
    in.index = i;
    ImpactResult result;
    if (n < 1) copy_input(in.ball1, in.ball2, ImpactStatus::kBadParameter, result);
    if (n >= 1 && enter_frame(in.ball1, in.ball2, in.params, in.frame, in.state, result) == ImpactStatus::kOk)
        return true;
    store_result(out, i, result);
    return false;
}

// Stores the result after this number of steps; -1: the march reached its limit of steps.
inline void leave_impact(const BatchImpact& in, long steps, const ImpactBatchResult& out) {
    ImpactResult result;
    if (steps < 0)
        copy_input(in.ball1, in.ball2, ImpactStatus::kStepLimit, result);
    else
        leave_frame(in.ball1, in.ball2, in.frame, in.state, steps, result);
    store_result(out, in.index, result);
}

}  // namespace
}  // namespace carom::kernel
