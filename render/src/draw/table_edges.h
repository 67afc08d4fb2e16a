// The edges of a table mesh at which two surfaces of different look may meet in a picture.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "carom/render/image.h"
#include "carom/render/table_mesh.h"
#include "draw/view.h"

namespace carom::render {

/// Marks, in the fourth channel of a picture, a pixel of the playing surface. Other faces have the marks 1 to
/// kLastFace; 0 is the background, or something that was drawn over the table.
inline constexpr std::uint8_t kClothFace = 255, kLastFace = 127;

struct TableEdge {
    /// A triangle at this edge.
    struct Side {
        std::uint8_t face = 0;          ///< 0: no second triangle
        std::array<float, 3> corner{};  ///< the corner that is not on the edge
    };
    std::array<float, 3> a{}, b{};  ///< relative to TableMesh::origin [m]
    std::array<Side, 2> sides;
    bool smooth = false;  ///< inside a curved surface: visible only where the surface turns away from the eye
};

/// A face is a set of triangles of one material that join without a crease and without a seam in the grain.
/// If a table has more than kLastFace faces, some share a mark and get no smooth edge where they meet.
struct TableEdges {
    std::vector<std::uint8_t> faces;  ///< the mark of every triangle of TableMesh::solid
    std::vector<TableEdge> edges;
};

TableEdges find_edges(const TableMesh& table);

/// Boxes outside which one sample in the middle of a pixel is as good as many: no edge or line of the table
/// passes within a pixel, and each pixel differs from its neighbours by few levels. (Walls that cut into each
/// other, borders of holes and grain show by their contrast.)
/// @param rgba a picture with one such sample, whose alpha distinguishes cloth from the rest.
std::vector<PixelBox> busy_tiles(const std::vector<std::uint8_t>& rgba, FrameSize size,
                                 const TableMesh& table, const View& view);

}  // namespace carom::render
