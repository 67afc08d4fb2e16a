// Which build of the kernel by tolerance runs, and the names of its methods.
#include "carom/kernel/tolerance.h"

namespace carom::kernel {

#define CAROM_DECLARE_TOLERANCE(isa)                                                                     \
    void tolerance_##isa(const Ball&, const Ball&, const ImpactParams&, double, ImpactResult&) noexcept; \
    void tolerance_batch_##isa(const ImpactBatch&, double, const ImpactBatchResult&) noexcept;

CAROM_DECLARE_TOLERANCE(scalar)
CAROM_DECLARE_TOLERANCE(v3)
CAROM_DECLARE_TOLERANCE(v4)

ToleranceFunction tolerance_function(Isa isa) noexcept {
    switch (isa) {
        case Isa::kScalar:
            return tolerance_scalar;
        case Isa::kV3:
            return tolerance_v3;
        case Isa::kV4:
            return tolerance_v4;
    }
    return tolerance_scalar;
}

ToleranceBatchFunction tolerance_batch_function(Isa isa) noexcept {
    switch (isa) {
        case Isa::kScalar:
            return tolerance_batch_scalar;
        case Isa::kV3:
            return tolerance_batch_v3;
        case Isa::kV4:
            return tolerance_batch_v4;
    }
    return tolerance_batch_scalar;
}

const char* name(ToleranceMethod method) noexcept {
    switch (method) {
        case ToleranceMethod::kNone:
            return "";
        case ToleranceMethod::kClosedFrictionless:
            return "closed_frictionless";
        case ToleranceMethod::kClosedGearing:
            return "closed_gearing";
        case ToleranceMethod::kClosedStick:
            return "closed_stick";
        case ToleranceMethod::kCollocation4:
            return "collocation_4";
        case ToleranceMethod::kCollocation8:
            return "collocation_8";
        case ToleranceMethod::kAdaptive:
            return "adaptive";
    }
    return "unknown";
}

}  // namespace carom::kernel
