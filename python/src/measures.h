// Measures, for the sweeps.
#pragma once

#include <optional>
#include <string>

#include "carom/games/rules.h"
#include "native.h"

namespace carom::python {

/// @throws nb::value_error for another game
std::optional<games::Game> game_or_none(const std::optional<std::string>& game);

}  // namespace carom::python
