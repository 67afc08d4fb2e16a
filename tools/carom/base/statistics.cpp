#include "base/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace carom::tools {
namespace {

// [-] Of the normal distribution: 95 % lie within.
constexpr double kZ = 1.959963984540054;

}  // namespace

Share share_of(std::size_t part, std::size_t whole) {
    if (whole == 0) return {0.0, 0.0, 1.0};
    const double n = static_cast<double>(whole), p = static_cast<double>(part) / n, z2 = kZ * kZ / n;
    const double middle = (p + 0.5 * z2) / (1.0 + z2);
    const double half = kZ * std::sqrt(p * (1.0 - p) / n + 0.25 * z2 / n) / (1.0 + z2);
    return {p, std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

std::string share_text(const Share& share) {
    return fmt::format("{:6.2f} %  ({:.2f} to {:.2f})", 100.0 * share.value, 100.0 * share.low,
                       100.0 * share.high);
}

}  // namespace carom::tools
