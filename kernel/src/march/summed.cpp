// The summed integration, or the published one if rounding decides. Built once per instruction set.
#include <cstdint>

#include "march/summed.h"

#include "kernel_set.h"
#include "unlike/unlike.h"

namespace carom::kernel::CAROM_ISA_NAMESPACE {
namespace {

// Returns false if the published integration is needed.
bool summed(const Ball& ball1, const Ball& ball2, const ImpactParams& params, int n, ImpactResult& result) {
    Frame frame;
    FrameState state;
    if (n < Summed::kFewestSubsteps || !alike(params)) return false;
    if (enter_frame(ball1, ball2, params, frame, state, result) != ImpactStatus::kOk) return true;
    const std::int64_t steps =
        params.cloth_slip == ClothSlip::kAsPublished
            ? Summed::loop<+1>(state, params, n)
            : Summed::loop<-1>(state, params, n);  // NOLINT(misc-redundant-expression): +1, -1
    if (steps >= 0) leave_frame(ball1, ball2, frame, state, steps, result);
    return steps >= 0;
}

}  // namespace

void summed_march(const Ball& ball1, const Ball& ball2, const ImpactParams& params, int n,
                  ImpactResult& result) noexcept {
    if (!summed(ball1, ball2, params, n, result)) march(ball1, ball2, params, n, result);
}

}  // namespace carom::kernel::CAROM_ISA_NAMESPACE
