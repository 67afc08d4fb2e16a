// The decisions of the plan: which effects a scene needs.
#pragma once

#include "carom/engine/plan.h"
#include "plan/reach.h"
#include "plan/words.h"

namespace carom {

/// Fills Plan::effects, and removes skipped effects from the plan: lists, coefficients, models. The plan's
/// geometry, balls, and cushion models must be those of its scene.
/// @param say  whether reasons are wanted
/// @throws SceneError at the line of an [effects] key that excludes what the scene needs
void decide_effects(Plan& plan, ReachMemory& memory, const Words& say);

}  // namespace carom
