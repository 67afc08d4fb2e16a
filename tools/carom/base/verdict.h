// Measures as JSON, and the cue of the next shot.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "carom/games/measures.h"

namespace carom::tools {

/// The value of a measure: a number or null, a truth, or texts. @throws std::invalid_argument as Measure::of
nlohmann::ordered_json measure_json(const games::Measure& measure, const Record& record);

/// The cue of the previous shot, aimed at the nearest ball that may be hit first, at its height and without
/// side.
/// @param first  ids of these balls; empty: any ball
Cue next_cue(const Scene& table, const Cue& before, const std::string& ball,
             const std::vector<std::string>& first);

}  // namespace carom::tools
