#include "base/statistics.h"

#include <fmt/format.h>

#include <string>

namespace carom::tools {

std::string share_text(const Share& share) {
    return fmt::format("{:6.2f} %  ({:.2f} to {:.2f})", 100.0 * share.value, 100.0 * share.low,
                       100.0 * share.high);
}

}  // namespace carom::tools
