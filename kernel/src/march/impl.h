// The published march from table coordinates and back: the plain reference that every faster form is compared
// with. Built once per instruction set; CAROM_MARCH_NAME is the name of the function.
#pragma once

#include "march/loop.h"

namespace carom::kernel {

void CAROM_MARCH_NAME(const Ball& ball1, const Ball& ball2, const ImpactParams& params, int n,
                      ImpactResult& result) noexcept {
    if (n < 1) {
        copy_input(ball1, ball2, ImpactStatus::kBadParameter, result);
        return;
    }
    Frame frame;
    FrameState state;
    if (enter_frame(ball1, ball2, params, frame, state, result) != ImpactStatus::kOk) return;
    const long steps = params.cloth_slip == ClothSlip::kAsPublished ? march_loop<+1>(state, params, n)
                                                                    : march_loop<-1>(state, params, n);
    if (steps < 0)
        copy_input(ball1, ball2, ImpactStatus::kStepLimit, result);
    else
        leave_frame(ball1, ball2, frame, state, steps, result);
}

}  // namespace carom::kernel
