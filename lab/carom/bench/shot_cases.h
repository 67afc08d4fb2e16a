// The scenes of carom-lab bench shot and of lab/measure/callgrind_shot.py: seeded, so that name and seed
// define the same shot everywhere.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "carom/engine/scene.h"

namespace carom::tools {

/// Names of the shots, in the order of the table.
std::vector<std::string> shot_names();

/// A shot by name. Seeds vary rack, aim and speed; seed 0 of the eight-ball break is the shot of
/// scenes/eight_ball_break.toml. @throws std::invalid_argument for an unknown name
Scene shot_scene(const std::string& name, std::uint64_t seed);

/// The scene of a batch (many_shots.h), with every coefficient written out. @throws std::invalid_argument for
/// an unknown name
Scene many_scene(const std::string& name);

/// n frictionless, elastic balls moving at 1 m/s in random directions in a box of reflecting cushions, on a
/// jittered grid; balls cover a fifth of the area for any n. Stops after `events`.
Scene gas_scene(int n, long events, std::uint64_t seed);

}  // namespace carom::tools
