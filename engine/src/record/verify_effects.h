// Effects that the plan skipped although the record shows that they were needed.
#pragma once

#include <optional>

#include "carom/engine/verify.h"

namespace carom {

/// Checks every segment: whether a ball hits a cushion or jaw, enters a pocket, or hits another ball for
/// which the plan has no detector; and whether it has vertical spin, slips or rolls although the plan skipped
/// that friction. Law "E".
std::optional<Violation> verify_skipped(const Record& record, const Plan& plan);

}  // namespace carom
