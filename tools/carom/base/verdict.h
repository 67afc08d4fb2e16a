// Verdicts of games in words and as JSON, and the shot that follows.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "carom/games/measures.h"
#include "carom/games/player.h"
#include "carom/games/rules.h"

namespace carom::tools {

/// A strike: {speed, aim_deg, elevation_deg, offset}.
nlohmann::ordered_json cue_json(const carom::Cue& cue);

/// The advice of `carom advise --json`.
nlohmann::ordered_json advice_json(const std::vector<games::Advice>& advice, const carom::Table& table);

/// The value of a measure: a number or null, a truth, or texts. @throws std::invalid_argument as Measure::of
nlohmann::ordered_json measure_json(const games::Measure& measure, const Record& record);

/// The cue of the previous shot, aimed at the nearest ball that may be hit first, at its height and without
/// side.
/// @param first  ids of these balls; empty: any ball
Cue next_cue(const Scene& table, const Cue& before, const std::string& ball,
             const std::vector<std::string>& first);

}  // namespace carom::tools
