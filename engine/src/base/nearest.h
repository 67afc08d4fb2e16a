// "Did you mean": what a mistyped name stands near to.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace carom {

/// The end of a message about `word`, which is none of `names`: "; did you mean aim_deg?", with all of them
/// where several are equally near, or "" where none is. Near are at most two letters that are missing, too
/// many, other ones, or swapped with their neighbour, in words that are for the most part alike, and names
/// that begin with the word or the other way round (aim, aim_deg). Capitals do not count.
std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& names);

}  // namespace carom
