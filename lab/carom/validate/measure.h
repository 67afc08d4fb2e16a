// What a measurement of a real table reads in a record: every quantity of the cases, in one place.
#pragma once

#include "carom/engine/record.h"
#include "validate/case.h"

namespace carom::tools {

/// The number of one shot that was measured, in the unit of its quantity; nothing that is a share.
/// @throws std::runtime_error where the shot has no such instant, such as that of a cushion that is not met
double measure(const Record& record, const Measured& what);

/// Whether a shot counts for a share.
bool counts(const Record& record, const Measured& share);

}  // namespace carom::tools
