// Checks each motion of a record by itself.
#pragma once

#include <optional>

#include "carom/engine/tolerances.h"
#include "carom/engine/verify.h"

namespace carom {

// [m], [s] and [of the speeds] Places, times and rates that differ by less are equal; a program that writes
// records may round.
constexpr double kSamePlace = 1e-9, kSameTime = 1e-9, kSameShare = 1e-9;
inline double same_time(double t) {
    return kSameTime + 8.0 * kEpsilon * t;
}

/// Checks the order of times (law "U2"), and that every segment follows from its state (law "U7"). All
/// numbers of the record are finite.
std::optional<Violation> verify_motion(const Record& record, const Plan& plan);

/// Checks the rest, the duration and the pockets that the record states (law "U8").
std::optional<Violation> verify_end(const Record& record, const Plan& plan);

}  // namespace carom
