// Section 3.2, before refinement: the 12 bits of rsqrtss. Their error is the reason for the Newton steps of
// rsqrt_newton.h.
#pragma once

#include "ladder/inverse_step.h"

namespace carom::kernel {
namespace {
using RsqrtRaw = WithStep<InverseStep<RawRoot>>;
}  // namespace
}  // namespace carom::kernel
