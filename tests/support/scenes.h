// Shipped scenes, and a small file for tests of its variations.
#pragma once

#include <string>

#include "carom/engine/scene.h"

namespace carom::test {

inline Scene shipped(const std::string& name) {
    return read_scene(std::string(CAROM_SOURCE_DIR) + "/scenes/" + name + ".toml");
}

inline constexpr char kSmallScene[] = R"([table]
cushion = [{from = [0, 0], to = [0, 3], height = 0.03}, {from = [2, 0], to = [2, 3], height = 0.03}]
pocket = [{center = [1.0, 3.0], radius = 0.06}]
[[ball]]
position = [0.635, 0.50]
[[ball]]
id = "ball.2"
position = [0.60, 2]
[cue]
speed = 4
offset = [0.2, 0.1]
)";

}  // namespace carom::test
