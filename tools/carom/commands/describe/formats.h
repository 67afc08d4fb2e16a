// The formats of files, described for programs and people from the tables of their keys (carom/engine/field.h).
#pragma once

#include <string>

namespace carom::tools {

/// A JSON Schema of scene files: docs/reference/scene.schema.json.
std::string scene_schema();
/// A JSON Schema of records: docs/reference/record.schema.json, its parts that are tables in the program written anew.
std::string record_schema();
/// The page of scene files: docs/reference/scene_format.md, its tables between <!-- begin NAME --> and <!-- end NAME -->
/// written anew.
std::string scene_format();

}  // namespace carom::tools
