// Reads the measured quantities of real tables from a record: every quantity of the cases, in one place.
#pragma once

#include "carom/engine/record.h"
#include "validate/case.h"

namespace carom::tools {

/// The measured number of one shot, in the unit of its quantity; not for quantities of many shots.
/// @throws std::runtime_error if the shot lacks the instant, such as a cushion impact
double measure(const Record& record, const Measured& what);

}  // namespace carom::tools
