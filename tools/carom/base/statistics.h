// Shares of shots and their intervals.
#pragma once

#include <fmt/format.h>

#include <string>

#include "carom/games/solve.h"

namespace carom::tools {

using games::Share;
using games::share_of;
inline std::string share_text(const Share& share) {
    return fmt::format("{:6.2f} %  ({:.2f} to {:.2f})", 100.0 * share.value, 100.0 * share.low,
                       100.0 * share.high);
}

}  // namespace carom::tools
