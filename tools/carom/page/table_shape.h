// The table as flat outlines seen from above, for a page that draws it without triangles.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "carom/render/table_mesh.h"

namespace carom::tools {

/// The triangles of lines and spots on the cloth, cut at their edges: those of the mesh reach farther, so
/// that a shader can smooth them.
std::vector<std::array<render::MeshVertex, 3>> table_marks(const render::TableMesh& mesh);

/// Outlines in m of the table's frame, each a closed list of numbers x, y, x, y, ..., to be filled by the
/// non-zero rule. An object of
/// - bounds {low, high}, inner {low, high}: what to show, and the box inside the wooden frame
/// - lamp {center, half, endless}, wood_top
/// - cloth, cushion, trim, inlay, chalk: lists of outlines
/// - wood: a list of boards {loops, grain}; the six numbers of grain give u = g0 x + g1 y + g2 along the
///   board and v = g3 x + g4 y + g5 across it
/// - holes: a list of {center, radius}
/// - numbers: a list of {at, number}: the diamonds' numbers, on the cushions
/// @param mesh of this table
nlohmann::ordered_json table_shape(const carom::Table& table, const render::TableMesh& mesh);

}  // namespace carom::tools
