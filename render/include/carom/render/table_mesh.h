// The table as triangles, made from the same cushions, jaws and pockets that the simulation uses.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "carom/engine/table.h"
#include "carom/render/camera.h"
#include "carom/render/look.h"

namespace carom::render {

enum class Material : std::uint8_t {
    kCloth,    ///< the playing surface; only here do balls cast shadows
    kCushion,  ///< cloth over rubber
    kWood,     ///< texture coordinates [m]: u along the grain, v across it, other numbers on each board
    kPocket,   ///< the wall of a hole; v is 0 at its mouth and 1 at its bottom, u is 1 on the bottom
    kTrim,     ///< the rim of a pocket
    kInlay,    ///< diamonds
    kFloor,    ///< of the room; like its walls and the lamp, visible from one side only
    kWall,
    kLamp,   ///< u is 1 where it shines
    kShade,  ///< black, blended over the cloth; u is the opacity
    /// white, blended over the cloth; u is the opacity, v the distance from the middle in half widths
    kChalk,
};

struct MeshVertex {
    float x, y, z;     ///< relative to TableMesh::origin [m]
    float nx, ny, nz;  ///< unit normal
    float u, v;
    float material;
};

struct Hole {
    Vec2 center{0.0, 0.0};
    double radius = 0.0;
};

/// The lamp above the table: a horizontal rectangle.
struct Lamp {
    Vec3 center{0.0, 0.0, 1.0};
    Vec2 half{0.5, 0.5};
    bool endless = false;  ///< the light does not decrease with distance; for an unbounded cloth
};

struct TableMesh {
    Vec2 origin{0.0, 0.0};
    std::vector<MeshVertex> solid, blended;          ///< three vertices per triangle
    std::vector<Hole> holes;                         ///< of pockets; the first 128 are cut out of the cloth
    Vec2 inner_low{0.0, 0.0}, inner_high{0.0, 0.0};  ///< box inside the wooden frame
    std::vector<std::array<Vec2, 2>> noses;          ///< straight pieces of the cushions' edges
    double wood_top = 0.0;
    Bounds bounds;  ///< the part that a camera should show
    look::Color cloth = look::kCloth;
    Lamp lamp;
};

/// kRounded: noses and rails have small bevels. kSharp: they have none, because strips thinner than a pixel
/// would flicker under a moving camera.
enum class Edges : std::uint8_t { kRounded, kSharp };

/// Makes the mesh. `visited`: positions that balls reach; they decide on which side of an open cushion its
/// body lies, and which part of an unbounded cloth is shown. R: ball radius [m].
TableMesh make_table_mesh(const Table& table, double R, const std::vector<Vec2>& visited,
                          Edges edges = Edges::kRounded);

/// The number of a diamond, and where it is written: on the cushion beside it. 0 to 8 along long rails and 1
/// to 3 along short ones, from the table's corner; none in front of a pocket or on an endless cloth.
struct DiamondNumber {
    Vec2 at;
    int number;
};
std::vector<DiamondNumber> diamond_numbers(const Table& table, const TableMesh& mesh);

}  // namespace carom::render
