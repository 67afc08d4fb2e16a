// Cuts convex polygons of mesh vertices along vertical planes.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "carom/render/table_mesh.h"

namespace carom::render {

/// A convex polygon: its corners in order.
using Corners = std::vector<MeshVertex>;

enum class Axis : std::uint8_t { kX, kY };

/// The parts of a polygon below and above the plane at which the coordinate [m,
/// relative to TableMesh::origin] has the value `at`; a part may be empty. Two
/// polygons with a common edge get the same new corner on it, bit for bit.
std::pair<Corners, Corners> cut(const Corners& polygon, Axis axis, float at);

}  // namespace carom::render
