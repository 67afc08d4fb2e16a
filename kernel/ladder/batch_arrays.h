// Reads one impact from the arrays of a batch, and writes its result into them.
#pragma once

#include "carom/kernel/batch.h"

namespace carom::kernel {
namespace {

inline void load_impact(const ImpactBatch& batch, long i, Ball& b1, Ball& b2, ImpactParams& p) {
    for (int k = 0; k < 3; ++k) {
        b1.r[k] = batch.ball1.r[k][i];
        b1.v[k] = batch.ball1.v[k][i];
        b1.w[k] = batch.ball1.w[k][i];
        b2.r[k] = batch.ball2.r[k][i];
        b2.v[k] = batch.ball2.v[k][i];
        b2.w[k] = batch.ball2.w[k][i];
    }
    p = {batch.params.R[i],    batch.params.m[i],   batch.params.mu_s1[i],  batch.params.mu_s2[i],
         batch.params.mu_b[i], batch.params.e_b[i], batch.params.cloth_slip};
}

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

}  // namespace
}  // namespace carom::kernel
