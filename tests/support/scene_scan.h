// Runs ranges of seeded scenes and reports failures; for work on contacts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "carom/engine/scene.h"

namespace carom::test {

/// A scene of "random" (also ""), "other" or a family of crowded or natural scenes; none for an unknown
/// family.
std::optional<Scene> seeded_scene(const std::string& family, std::uint64_t seed);

/// Runs the scenes that the text selects; prints a line for each scene that fails, is given up or needs more
/// than 50 ms of CPU, and a summary.
/// * "FROM:COUNT", "FROM:COUNT:other": the two families of support/random_scenes.h.
/// * "FROM:COUNT:FAMILY", "FROM:COUNT:FAMILY/LEVEL": a family of support/crowded_scenes.h or natural_shots.h.
/// * "SEED:1:FAMILY:toml": the scene file of one scene; ":least": the same without the balls that its fault
/// does not need.
/// * "families": their names.
/// It judges no time. @return the exit status: 0, or 2 if the text has another form
int scan_scenes(const char* wanted);

}  // namespace carom::test
