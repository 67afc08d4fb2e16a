// The formats of files, described for programs and people from the tables of their keys (carom/engine/field.h).
#pragma once

#include <string>

namespace carom::tools {

/// A JSON Schema of scene files: docs/reference/scene.schema.json.
std::string scene_schema();
/// What docs/reference/record.schema.json has from the tables: an object with a JSON pointer for each part of it.
std::string record_schema();
/// The tables of docs/reference/scene_format.md, each between the marks <!-- begin NAME --> and <!-- end NAME -->.
std::string scene_format();

}  // namespace carom::tools
