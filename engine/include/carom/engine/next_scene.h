// From the end of one shot to the next one.
#pragma once

#include "carom/engine/record.h"
#include "carom/engine/scene.h"

namespace carom {

/// The next shot: scene_after() with `cue`, checked. Balls in pockets and balls that left the table are gone;
/// the others lie where they rest, to the bit.
/// @param scene  that of the record: the same balls in the same order
/// @throws SceneError where that is no valid scene: the cue's ball is gone or still moves
Scene next_scene(const Scene& scene, const Record& record, const Cue& cue);

}  // namespace carom
