// Many independent impacts, as structures of arrays: the types that all batch kernels share.
//
// Lane i of a batch is one impact: element i of every array. Arrays need no alignment, and a batch may have
// any length, including 0. Results must not overlap inputs. Raw pointers, because files built for one
// instruction set include no std templates.
#pragma once

#include <cstdint>

#include "carom/kernel/impact.h"

namespace carom::kernel {

/// Input: one ball of every impact.
struct BallLanes {
    const double* r[3];  ///< centre [m]
    const double* v[3];  ///< velocity [m/s]
    const double* w[3];  ///< angular velocity [rad/s]
};

/// Input: the parameters of every impact, as in ImpactParams. The whole batch has one sign of the cloth slip.
struct ParamLanes {
    const double* R;
    const double* m;
    const double* mu_s1;
    const double* mu_s2;
    const double* mu_b;
    const double* e_b;
    ClothSlip cloth_slip = ClothSlip::kConsistent;
    /// As in ImpactParams; null: 1 for all.
    const double* mass_ratio = nullptr;
    const double* radius_ratio = nullptr;
};

/// Output: velocities of one ball after every impact.
struct VelocityLanes {
    double* v[3];
    double* w[3];
};

struct ImpactBatch {
    std::int64_t count;  ///< lanes; <= 0: none
    BallLanes ball1, ball2;
    ParamLanes params;
};

/// The results, per lane exactly as in ImpactResult.
struct ImpactBatchResult {
    VelocityLanes ball1, ball2;
    ImpactStatus* status;
    std::int64_t* steps;      ///< may be null
    ToleranceMethod* method;  ///< may be null
};

}  // namespace carom::kernel
