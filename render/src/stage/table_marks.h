// Painted or inlaid marks of a table: diamonds, strings and spots.
#pragma once

#include "stage/mesh_builder.h"

namespace carom::render {

/// Adds the marks of a preset; a custom outline has none.
/// rail: distance of the diamonds from the nose line [m].
void add_table_marks(const Table& table, TableMesh& mesh, MeshBuilder& builder, double rail);

}  // namespace carom::render
