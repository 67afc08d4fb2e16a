// The triangles of a table, sorted by the program that draws them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "carom/render/table_mesh.h"

namespace carom::render {

/// In the order of drawing. kCut...: the triangles that meet the square around a hole, where each pixel is
/// tested.
enum class Part : std::uint8_t {
    kCloth,
    kWood,
    kSmall,
    kFloor,
    kWall,
    kCutCloth,
    kCutWood,
    kChalk,
    kShade,
    kCutShade
};
inline constexpr std::size_t kPartCount = 10;

struct PartVertex {
    MeshVertex vertex;
    float face;  ///< the fourth channel of its pixels, 0..1
};

struct TableParts {
    std::vector<PartVertex> vertices;            ///< three for each triangle, part after part
    std::array<std::size_t, kPartCount> ends{};  ///< one past the last vertex of each part
};

/// Cuts the cloth, the wood and the shading along the squares around the holes, so that only the parts inside
/// these squares are tested. @param faces the mark of each triangle of table.solid; empty: 255 for the
/// playing surface and 0 for the rest
TableParts sort_parts(const TableMesh& table, const std::vector<std::uint8_t>& faces);

}  // namespace carom::render
