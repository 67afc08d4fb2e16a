// Puts triangles, strips and polygons into a TableMesh.
#pragma once

#include <vector>

#include "carom/render/table_mesh.h"
#include "stage/outline.h"

namespace carom::render {

/// One line of a profile that is swept along an outline.
struct ProfileRow {
    double offset;   ///< to the left of the outline [m]
    double z;        ///< [m], added to the height of the outline's point
    double opacity;  ///< for blended materials
};

class MeshBuilder {
  public:
    explicit MeshBuilder(TableMesh& mesh) : mesh_(mesh) {}

    void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, Material material, double u = 0.0);

    /// Horizontal polygon with its vertices at height z, seen from above.
    void polygon(const std::vector<Vec2>& outline, double z, Material material);

    /// Sweeps a profile along an outline. Neighbouring rows share smoothed normals when `smooth`.
    void sweep(const Chain& outline, const std::vector<ProfileRow>& rows, Material material, bool smooth);

    /// Level ring sector or full disc (inner = 0).
    void disc(const Vec2& center, double inner, double outer, double z, Material material, double u = 0.0);

    /// A vertical wall seen from inside.
    void well(const Vec2& center, double radius, double top, double bottom, Material material);

  private:
    MeshVertex vertex(const Vec3& p, const Vec3& n, double u, double v, Material material) const;
    void triangle(const MeshVertex& a, const MeshVertex& b, const MeshVertex& c);

    TableMesh& mesh_;
};

}  // namespace carom::render
