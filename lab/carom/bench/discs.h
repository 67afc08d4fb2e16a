// carom-lab bench discs: events a second beside a code for hard discs.
#pragma once

#include "bench/hard_discs.h"
#include "carom/engine/plan.h"

namespace carom::tools {

/// The discs of a gas (gas_scene()), whose plan this is: straight walls, no friction, nothing lost.
HardDiscs hard_discs(const Plan& plan);

}  // namespace carom::tools
