// Compares the events of a record with its segments, and computes every impact again.
#pragma once

#include <optional>

#include "carom/engine/verify.h"

namespace carom {

/// Checks the impacts (law "U5"), and that every change has its event and every event its change ("U6"). The
/// motions are in order.
std::optional<Violation> verify_events(const Record& record, const Plan& plan);

}  // namespace carom
