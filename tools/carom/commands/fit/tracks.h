// A file of tracked positions of balls.
#pragma once

#include <string>
#include <vector>

#include "carom/games/fit.h"

namespace carom::tools {

/// Reads a CSV file with a line of names first: t (or time), ball, x, y in any order; others are ignored. Any
/// rate, with gaps; an empty or nan position was not seen.
/// @throws UsageError "file:line:col: what is wrong and what to do"
std::vector<games::TrackPoint> read_tracks(const std::string& path, const Scene& scene);

}  // namespace carom::tools
