// From the end of one shot to the next one.
#pragma once

#include "carom/engine/record.h"
#include "carom/engine/scene.h"

namespace carom {

/// The next shot: scene_after() with `cue`, validated. Balls in pockets and off the table are removed; the
/// others lie exactly where they came to rest.
/// @param scene  that of the record: the same balls in the same order
/// @throws SceneError if that is not a valid scene: the cue's ball is gone or still moves
Scene next_scene(const Scene& scene, const Record& record, const Cue& cue);

}  // namespace carom
