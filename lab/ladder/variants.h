// The lists of kernel variants from variants.cpp, one per instruction set.
#pragma once

#include <span>

#include "ladder/ladder.h"

namespace carom::kernel {

namespace scalar {
extern const std::span<const Variant> kVariants;
}
#if defined(__x86_64__)
namespace v3 {
extern const std::span<const Variant> kVariants;
}
namespace v4 {
extern const std::span<const Variant> kVariants;
}
#endif

}  // namespace carom::kernel
