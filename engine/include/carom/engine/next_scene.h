// The scene of the next shot.
#pragma once

#include "carom/engine/record.h"
#include "carom/engine/scene.h"

namespace carom {

/// The next shot: scene_after() with `cue`, validated. Balls in pockets and off the table are removed; the
/// others keep exactly their final positions.
/// @param scene  of the record: the same balls in the same order
/// @throws SceneError if the result is invalid: the cue's ball is gone or still moves
Scene next_scene(const Scene& scene, const Record& record, const Cue& cue);

}  // namespace carom
