// Random draws by name: draws for one key do not depend on other draws or their order.
#pragma once

#include <cstdint>
#include <string_view>

#include "carom/kernel/splitmix64.h"

namespace carom {

/// The generator for `key` in shot `index` of a seed.
SplitMix64 draws_of(std::uint64_t seed, std::uint64_t index, std::string_view key);

/// Standard normal, by the ratio of uniforms: Kinderman, Monahan, "Computer generation of random variables
/// using the ratio of uniform deviates", ACM TOMS 3, 1977.
double standard_normal(SplitMix64& random);

}  // namespace carom
