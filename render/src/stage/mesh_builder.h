// Adds triangles, strips and polygons to a TableMesh.
#pragma once

#include <vector>

#include "carom/render/table_mesh.h"
#include "stage/outline.h"

namespace carom::render {

/// One line of a profile that is swept along an outline.
struct ProfileRow {
    double offset;   ///< distance to the left of the outline [m]
    double z;        ///< added to the height of the outline's point [m]
    double opacity;  ///< for blended materials
};

class MeshBuilder {
  public:
    explicit MeshBuilder(TableMesh& mesh) : mesh_(mesh) {}

    void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, Material material, double u = 0.0);

    /// A horizontal polygon at height z [m], visible from above.
    void polygon(const std::vector<Vec2>& outline, double z, Material material);

    /// Sweeps a profile along an outline. If `smooth`, the normals are averaged between neighbouring strips.
    void sweep(const Chain& outline, const std::vector<ProfileRow>& rows, Material material, bool smooth);

    /// A horizontal ring, or a full disc if inner = 0.
    void disc(const Vec2& center, double inner, double outer, double z, Material material, double u = 0.0);

    /// The vertical wall of a cylinder, visible from inside.
    void well(const Vec2& center, double radius, double top, double bottom, Material material);

  private:
    MeshVertex vertex(const Vec3& p, const Vec3& n, double u, double v, Material material) const;
    void triangle(const MeshVertex& a, const MeshVertex& b, const MeshVertex& c);

    TableMesh& mesh_;
};

}  // namespace carom::render
