// The table as indexed triangles, one list a material, for programs that know nothing of this renderer.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "carom/render/table_mesh.h"

namespace carom::tools {

struct TablePart {
    std::vector<float> positions,
        normals;  ///< three numbers a vertex, in the axes of glTF, relative to the mesh's origin
    std::vector<std::uint32_t> indices;  ///< three a triangle
};

/// The solid parts but the floor, with the holes of pockets cut out of cloth
/// and wood, which the renderer's shaders do; and the marks on the cloth.
std::map<render::Material, TablePart> table_parts(const render::TableMesh& mesh);

}  // namespace carom::tools
