// Whether anything in a plan takes energy.
#pragma once

#include "carom/engine/plan.h"

namespace carom {

/// Whether impacts return all energy, and there is no friction, no pocket and no flight. A nose above or
/// below the centre of a ball drives it into the cloth, and so takes some.
bool loses_nothing(const Plan& plan);

}  // namespace carom
