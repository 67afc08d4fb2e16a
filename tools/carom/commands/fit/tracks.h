// Tracked places of balls, as a file has them.
#pragma once

#include <string>
#include <vector>

#include "carom/games/fit.h"

namespace carom::tools {

/// Reads a CSV file with a line of names first: t, ball, x, y in any order; other columns are ignored. Any
/// rate, with gaps; a place that is empty or nan was not seen.
/// @throws UsageError "file:line:col: what is wrong and what to do"
std::vector<games::TrackPoint> read_tracks(const std::string& path, const Scene& scene);

}  // namespace carom::tools
