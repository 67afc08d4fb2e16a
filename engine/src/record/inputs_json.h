// The parts of a record that repeat its scene, as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "carom/engine/record.h"

namespace carom {

nlohmann::ordered_json table_json(const Table& table);
nlohmann::ordered_json balls_json(const BallParams& balls);

}  // namespace carom
