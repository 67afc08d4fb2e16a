// The lists of kernel variants that rungs.cpp makes, one for each instruction set.
#pragma once

#include <span>

#include "ladder/ladder.h"

namespace carom::kernel {

namespace scalar {
extern const std::span<const Rung> kRungs;
}
#if defined(__x86_64__)
namespace v3 {
extern const std::span<const Rung> kRungs;
}
namespace v4 {
extern const std::span<const Rung> kRungs;
}
#endif

}  // namespace carom::kernel
