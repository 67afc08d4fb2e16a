// Compares the events of a record with its segments, and computes every impact again.
#pragma once

#include <optional>

#include "carom/engine/verify.h"

namespace carom {

/// Checks the order of times (law "U2"), the impacts ("U5"), that every change has its event and every event
/// its change ("U6"), the motion of every segment ("U7"), and the end of the record ("U8"). All numbers of
/// the record are finite.
std::optional<Violation> verify_events(const Record& record, const Plan& plan);

}  // namespace carom
