// carom-lab bench discs: events per second compared with a hard-disc code.
#pragma once

#include "bench/hard_discs.h"
#include "carom/engine/plan.h"

namespace carom::tools {

/// The discs of the gas (gas_scene()) in this plan: straight walls, no friction, no losses.
HardDiscs hard_discs(const Plan& plan);

}  // namespace carom::tools
