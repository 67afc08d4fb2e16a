// Measures, for the sweeps.
#pragma once

#include <optional>
#include <string>

#include "carom/games/measures.h"
#include "native.h"

namespace carom::python {

/// @throws nb::value_error for another game
std::optional<games::Game> game_or_none(const std::optional<std::string>& game);
/// @throws nb::value_error for an expression that cannot be read
games::Measure measure_of(const std::string& text, const Scene& scene,
                          const std::optional<std::string>& game);

}  // namespace carom::python
