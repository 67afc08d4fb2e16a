// Section 3.2, before refinement: rsqrtss as it comes, 12 bits. The loss is what motivates the next rung.
#pragma once

#include "ladder/inverse_step.h"

namespace carom::kernel {
namespace {
using RsqrtRaw = WithStep<InverseStep<RawRoot>>;
}  // namespace
}  // namespace carom::kernel
