// Many independent ball-ball impacts at once.
#pragma once

#include <cstddef>

#include "carom/kernel/impact.h"
#include "carom/kernel/isa.h"

namespace carom::kernel {

/// `count` impacts as a structure of arrays: component k of ball 1's velocity in impact i is v1[k][i]. SI
/// units, as Ball and ImpactParams. The arrays need no alignment and may not overlap the results.
struct ImpactBatch {
    std::size_t count;
    const double *r1[3], *v1[3], *w1[3];
    const double *r2[3], *v2[3], *w2[3];
    const double *R, *m, *mu_s1, *mu_s2, *mu_b, *e_b;
    ClothSlip cloth_slip;
};

/// Results, one entry an impact, as ImpactResult. An impact that cannot be computed has its own status and
/// its input as velocities; the others are not touched by it.
struct ImpactBatchResult {
    double *v1[3], *w1[3];
    double *v2[3], *w2[3];
    long* steps;
    ImpactStatus* status;
};

/// The march of march.h with N substeps on every impact of the batch. Each impact's result depends on itself
/// alone, not on what shares its vector, and is the same bits on every instruction set; it differs from
/// march_function's by rounding (docs/kernel.md). `isa` must be available.
void collide_balls_batch(Isa isa, const ImpactBatch& batch, int n, const ImpactBatchResult& result) noexcept;

}  // namespace carom::kernel
