// An integration from table coordinates and back: validation, projection into the contact frame, loop,
// back-projection. Only the loop differs between kernel variants.
#pragma once

#include <cstdint>

#include "frame.h"

namespace carom::kernel {
namespace {

// March::loop<kSign>(state, params, n) integrates a state in the contact frame; kSign is the sign of the
// cloth slip. Returns the number of steps, or -1 at the limit of steps.
template <class March>
void drive(const Ball& ball1, const Ball& ball2, const ImpactParams& params, int n,
           ImpactResult& result) noexcept {
    if (n < 1) {
        copy_input(ball1, ball2, ImpactStatus::kBadParameter, result);
        return;
    }
    Frame frame;
    FrameState state;
    if (enter_frame(ball1, ball2, params, frame, state, result) != ImpactStatus::kOk) return;
    const std::int64_t steps =
        params.cloth_slip == ClothSlip::kAsPublished
            ? March::template loop<+1>(state, params, n)
            : March::template loop<-1>(state, params, n);  // NOLINT(misc-redundant-expression): +1, -1
    if (steps < 0)
        copy_input(ball1, ball2, ImpactStatus::kStepLimit, result);
    else
        leave_frame(ball1, ball2, frame, state, steps, result);
}

}  // namespace
}  // namespace carom::kernel
