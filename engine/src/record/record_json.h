// Format and version of record files, and the parts of a record that repeat its scene, as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "carom/engine/record.h"

namespace carom {

nlohmann::ordered_json table_json(const Table& table);
nlohmann::ordered_json balls_json(const BallParams& balls);

inline constexpr char kRecordFormat[] = "carom-record";
/// The written version. It may gain keys, as long as a reader that ignores them still draws the same shot
/// (docs/reference/record_format.md, "Versions").
inline constexpr int kRecordVersion = 4;
inline constexpr int kOldestVersion = 2;

}  // namespace carom
