// Section 3.2: rsqrtss and Newton steps. The published variant gives NaN at zero slip; here a zero slip takes no
// root.
#pragma once

#include "ladder/inverse_step.h"

namespace carom::kernel {
namespace {
using RsqrtNewton = WithStep<InverseStep<NewtonRoot>>;
}  // namespace
}  // namespace carom::kernel
