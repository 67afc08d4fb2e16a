// The decisions of the plan: which effects a scene needs.
#pragma once

#include "carom/engine/plan.h"
#include "plan/reach.h"
#include "plan/words.h"

namespace carom {

/// Fills Plan::effects, and removes skipped effects from the plan: lists, coefficients, models. The plan's
/// geometry, balls, and cushion models must be those of its scene.
/// @param say  whether to state reasons
/// @throws SceneError at the line of an [effects] key that excludes a needed effect
void decide_effects(Plan& plan, ReachMemory& memory, const Words& say);

}  // namespace carom
