#include "carom/engine/next_scene.h"

namespace carom {

Scene next_scene(const Scene& scene, const Record& record, const Cue& cue) {
    Scene next = scene_after(scene, record);
    next.cue = cue;
    validate(next);
    return next;
}

}  // namespace carom
