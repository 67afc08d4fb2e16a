// The decisions of the plan: which effects a scene can ever feel.
#pragma once

#include "carom/engine/plan.h"

namespace carom {

/// Fills Plan::effects and leaves out of the plan what is skipped: lists, coefficients, models. The plan's
/// geometry, balls, and cushion models must be those of the scene.
/// @throws SceneError at the line of an [effects] key that refuses what the scene needs
void decide_effects(const Scene& scene, Plan& plan);

}  // namespace carom
