// Many independent impacts at once, as structures of arrays: the types that every batch kernel shares.
//
// Lane i of a batch is one impact: element i of every array. Arrays need no alignment and a batch may have
// any length, 0 too. Results may not overlap inputs. Raw pointers, because files built for one instruction
// set include no std templates.
#pragma once

#include "carom/kernel/impact.h"

namespace carom::kernel {

/// One ball of every impact, read.
struct BallLanes {
    const double* r[3];  ///< centre [m]
    const double* v[3];  ///< velocity [m/s]
    const double* w[3];  ///< angular velocity [rad/s]
};

/// The parameters of every impact, read; as ImpactParams. The sign of the cloth slip is one for the batch.
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

/// Velocities of one ball after every impact, written.
struct VelocityLanes {
    double* v[3];
    double* w[3];
};

/// The impacts of one call.
struct ImpactBatch {
    long count;  ///< lanes; <= 0 is none
    BallLanes ball1, ball2;
    ParamLanes params;
};

/// What comes out, per lane exactly as ImpactResult.
struct ImpactBatchResult {
    VelocityLanes ball1, ball2;
    ImpactStatus* status;
    long* steps;              ///< may be null
    ToleranceMethod* method;  ///< may be null
};

}  // namespace carom::kernel
