// "Did you mean": the names closest to a mistyped one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace carom {

/// The end of a message about `word`, which is not in `names`: "; did you mean aim_deg?", listing all equally
/// near names, or "" if none is near. A name is near if at most two letters are missing, added, changed or
/// swapped with their neighbour and the words are mostly alike, or if one begins with the other (aim,
/// aim_deg). Ignores case, and 8-ball is eight_ball.
std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& names);

}  // namespace carom
