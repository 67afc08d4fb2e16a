// The formats of files, described for programs and people from the tables of their keys
// (carom/engine/field.h).
#pragma once

#include <string>
#include <vector>

#include "page/page.h"

namespace carom::tools {

/// record.schema.json and scene_format.md of docs/reference as they were when the program was built.
const std::vector<PageFile>& describe_files();

/// A JSON Schema of scene files: docs/reference/scene.schema.json.
std::string scene_schema();
/// A JSON Schema of record files: docs/reference/record.schema.json, with fresh parts from the tables of
/// their keys.
std::string record_schema();
/// The page of scene files: docs/reference/scene_format.md, with fresh tables between the marks <!-- begin
/// NAME --> and <!-- end NAME -->.
std::string scene_format();

}  // namespace carom::tools
