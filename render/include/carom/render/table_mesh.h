// The table as triangles, made from the cushions, jaws and pockets that balls really bounce off and fall into.
#pragma once

#include <cstdint>
#include <vector>

#include "carom/engine/table.h"
#include "carom/render/camera.h"

namespace carom::render {

enum class Material : std::uint8_t {
    kCloth,    ///< the playing surface; the only one that balls throw shadows on
    kCushion,  ///< cloth over rubber
    kWood,     ///< u along the grain, v across [m]
    kPocket,   ///< the wall of a hole
    kTrim,     ///< the rim of a pocket
    kInlay,    ///< diamonds
    kFloor,
    kShade,  ///< blended over the cloth: black, u = opacity
    kChalk,  ///< blended over the cloth: white, u = opacity
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

/// The lamp above the table: a level rectangle.
struct Lamp {
    Vec3 center{0.0, 0.0, 1.0};
    Vec2 half{0.5, 0.5};
    bool endless = false;  ///< light that does not fall off: for a cloth without end
};

struct TableMesh {
    Vec2 origin{0.0, 0.0};
    std::vector<MeshVertex> solid, blended;          ///< three vertices a triangle
    std::vector<Hole> holes;                         ///< of pockets; the first 128 are cut out of the cloth
    Vec2 inner_low{0.0, 0.0}, inner_high{0.0, 0.0};  ///< box without wood
    double wood_top = 0.0;
    Bounds bounds;  ///< what a camera should show
    Lamp lamp;
};

/// Makes the table. `visited`: places that balls come to; they decide on which side of an open cushion its
/// body lies, and what of an endless cloth is shown. R: ball radius.
TableMesh make_table_mesh(const Table& table, double R, const std::vector<Vec2>& visited);

}  // namespace carom::render
