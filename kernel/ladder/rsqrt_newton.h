// Section 3.2: rsqrtss and Newton steps. The published rung gives NaN at zero slip; here zero slip takes no
// root at all.
#pragma once

#include "ladder/inverse_step.h"

namespace carom::kernel {
namespace {
using RsqrtNewton = WithStep<InverseStep<NewtonRoot>>;
}  // namespace
}  // namespace carom::kernel
