// A table for a page that draws it with WebGL.
#pragma once

#include <string>

#include "carom/render/table_mesh.h"

namespace carom::render {

/// Floats of the machine: the mesh's origin, the ends of its ten parts in vertices, and ten numbers for each
/// vertex: place, normal, u, v, material, and the share of cloth. Then the atlas of digits, 192 x 288 bytes.
std::string table_bytes(const TableMesh& table);

}  // namespace carom::render
