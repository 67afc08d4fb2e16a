// Deliberately crowded seeded scenes, and seeded shots as people play them: families for long campaigns.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "carom/engine/scene.h"

namespace carom::test {

/// How far the parameters of a crowded scene go.
/// * Natural: pool balls with several restitutions; 0.01 to 8 m/s.
/// * Wide: R 1 to 10 cm, g 1 to 20 m/s^2, mu_s 0.01 to 1, mu_r at most 0.3 mu_s, mu_b to 0.95, restitutions
/// and f_c 0 to 1, 0.01 to 8 m/s.
/// * Extreme: R 1 mm to 1 m, g 0.01 to 100 m/s^2, mu_s 1e-6 to 5, 1e-5 to 10 m/s; the rest as wide.
/// The last two stop after 60 s or 20 000 events.
enum class Level { kNatural, kWide, kExtreme };

/// Narrow channels, rows between walls, and so on; a crowded family has three levels.
std::span<const char* const> crowded_families();

/// The scene of a seed, or nothing for an unknown family or level: "rings", "rings/wide", "pool_frozen".
/// Seeds of different families and levels are independent. `validate` may refuse the scene if its balls do
/// not fit.
std::optional<Scene> family_scene(std::string_view family, std::uint64_t seed);

}  // namespace carom::test
