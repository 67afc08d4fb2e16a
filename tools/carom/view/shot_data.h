// What a page needs to know of a shot beside its record.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "carom/engine/record.h"

namespace carom::tools {

/// The record as write_record writes it.
std::string record_text(const Record& record);

/// An object of `shape` (table_shape.h) and `styles`, a list with {color, pattern, number} of each ball: the renderer's look.
nlohmann::ordered_json shot_json(const Record& record);

}  // namespace carom::tools
