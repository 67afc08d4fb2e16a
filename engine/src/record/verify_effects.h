// Late need: an effect that the plan left out and that the record shows was needed after all.
#pragma once

#include <optional>

#include "carom/engine/verify.h"

namespace carom {

/// Looks at every segment: does a ball meet a cushion or jaw, enter a pocket,
/// or meet another ball that the plan has no detector for; has it vertical
/// spin, does it slip or roll where the plan left the friction out. Law "E".
std::optional<Violation> verify_skipped(const Record& record, const Plan& plan);

}  // namespace carom
