// A shot as glTF: the table, the balls, and their motion as one animation.
#pragma once

#include <string>

#include "carom/engine/record.h"

namespace carom::tools {

struct GltfOptions {
    bool linear = false;  ///< join sampled positions by straight lines instead of cubics between events
    double fps = 120.0;   ///< of the samples
};

/// The bytes of a .glb file.
std::string shot_gltf(const Record& record, const GltfOptions& options);

}  // namespace carom::tools
