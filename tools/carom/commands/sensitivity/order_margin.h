// How far a number of a scene can change before the balls meet other things.
#pragma once

#include <string>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"

namespace carom::tools {

/// The change of one input up to which every ball has the same events in the same order; infinite if none was
/// found. Derivatives are invalid beyond it.
struct OrderMargin {
    double down, up;               ///< >= 0, in the unit of the input
    std::string down_why, up_why;  ///< the event that is new or missing there; "" if none
};

/// Plays shots with larger and larger changes of the input, each twice the last one, then bisects the first
/// change of an event. It misses events that come and go between two of these changes.
/// @param record  of this plan
/// @param first  the smallest change that is tried
OrderMargin order_margin(const Plan& plan, const Record& record, const std::string& input, double first);

}  // namespace carom::tools
