#include "base/draws.h"

#include <cmath>

#include "base/fnv.h"
#include "carom/engine/math.h"

namespace carom {

SplitMix64 draws_of(std::uint64_t seed, std::uint64_t index, std::string_view key) {
    Fnv hash;
    hash.add(seed);
    hash.add(index);
    hash.add(key);
    return SplitMix64(hash.value());
}

double standard_normal(SplitMix64& random) {
    const double width = 2.0 * std::sqrt(2.0 * exponential(-1.0));  // sqrt(8 / e)
    for (;;) {
        const double u = 1.0 - random.uniform();  // in (0, 1]
        const double x = width * (random.uniform() - 0.5) / u;
        if (u <= exponential(-0.25 * x * x)) return x;
    }
}

}  // namespace carom
