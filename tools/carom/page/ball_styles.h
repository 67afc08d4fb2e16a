// The look of balls, for a page that draws them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace carom::tools {

/// A list of {color, pattern, number}, one for each ball: the renderer's look of a ball with this id on this
/// table.
nlohmann::ordered_json ball_styles(const std::vector<std::string>& ids, const std::string& table_preset);

}  // namespace carom::tools
