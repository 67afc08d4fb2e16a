// The table as indexed triangles, one list per material, for programs that do not know this renderer.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "carom/render/table_mesh.h"

namespace carom::tools {

struct TablePart {
    std::vector<float> positions,
        normals;  ///< three numbers per vertex, in glTF axes, relative to the mesh's origin
    std::vector<std::uint32_t> indices;  ///< three per triangle
};

/// The solid parts except the floor, and the marks on the cloth. Pocket holes are cut out of cloth and wood,
/// which the renderer leaves to its shaders.
std::map<render::Material, TablePart> table_parts(const render::TableMesh& mesh);

}  // namespace carom::tools
