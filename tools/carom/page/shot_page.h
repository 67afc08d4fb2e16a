// The page that plays a shot, for `carom view` and for notebooks.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "carom/engine/record.h"

namespace carom::tools {

/// The header of the page.
struct ShotPageTexts {
    std::string title;
    /// The command that made it, and its version.
    std::string command, version;
};

/// "16 balls, 212 events, 9.103 s"
std::string shot_lead(const Record& record);

/// The whole file. @param second another shot to show over or beside the first; may be null
/// @param margin the chart of its frames' costs (margin_chart), or null
std::string shot_page(const Record& record, const Record* second, const nlohmann::ordered_json& margin,
                      const ShotPageTexts& texts);

}  // namespace carom::tools
