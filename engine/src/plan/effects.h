// The decisions of the plan: which effects a scene can ever feel.
#pragma once

#include "carom/engine/plan.h"
#include "plan/reach.h"
#include "plan/words.h"

namespace carom {

/// Fills Plan::effects and leaves out of the plan what is skipped: lists, coefficients, models. The plan's
/// geometry, balls, and cushion models must be those of its scene.
/// @param say  whether reasons are wanted
/// @throws SceneError at the line of an [effects] key that refuses what the scene needs
void decide_effects(Plan& plan, ReachMemory& memory, const Words& say);

}  // namespace carom
