// Seeded shots as people play them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "carom/engine/scene.h"

namespace carom::test {

/// Pool after a break, with frozen balls; snooker with the pack half open, with frozen balls; the cue ball
/// touching, inside and shot into a touching pack; the eight-ball break; breaks of four games with a raised
/// cue.
std::span<const char* const> natural_families();

/// The shot of a seed, or nothing for an unknown family.
std::optional<Scene> natural_shot(std::string_view family, std::uint64_t seed);

}  // namespace carom::test
