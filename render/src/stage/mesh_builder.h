// Adds triangles, strips and polygons to a TableMesh.
#pragma once

#include <vector>

#include "carom/engine/table.h"
#include "carom/render/mesh_cut.h"
#include "carom/render/table_mesh.h"

namespace carom::render {

/// Cushion noses joined end to end, including the arcs of jaws.
struct Chain {
    std::vector<Vec2> points;     ///< a closed chain does not repeat its first point
    std::vector<double> heights;  ///< height of the nose at each point [m]
    bool closed = false;
    bool has_jaw = false;
};

/// Joins cushions whose ends coincide or lie on the same jaw circle (along its shorter arc).
std::vector<Chain> join_outline(const Table& table);

/// Signed area of a polygon; positive if it is counter-clockwise.
double signed_area(const std::vector<Vec2>& polygon);

bool contains(const std::vector<Vec2>& polygon, const Vec2& point);

/// Moves every vertex by `distance` to the left of the line
/// with mitred corners (mitre at most about three times that).
std::vector<Vec2> offset_left(const std::vector<Vec2>& points, bool closed, double distance);

/// Triangulates a simple counter-clockwise polygon by ear clipping; returns index triples.
std::vector<int> triangulate(const std::vector<Vec2>& polygon);

void reverse(Chain& chain);

/// One line of a profile that is swept along an outline.
struct ProfileRow {
    double offset;        ///< distance to the left of the outline [m]
    double z;             ///< added to the height of the outline's point [m]
    double opacity;       ///< for blended materials
    double across = 0.0;  ///< for chalk: distance from the middle of the line, in half widths of the line
};

class MeshBuilder {
  public:
    explicit MeshBuilder(TableMesh& mesh) : mesh_(mesh) {}

    void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, Material material, double u = 0.0);

    /// A polygon at height z [m], visible from above.
    void polygon(const std::vector<Vec2>& outline, double z, Material material);

    /// Sweeps a profile along an outline. If `smooth`, the normals are averaged between neighbouring strips.
    void sweep(const Chain& outline, const std::vector<ProfileRow>& rows, Material material, bool smooth);

    /// A horizontal disc. For a blended material `u` is its opacity; `edge`, for
    /// chalk: radius of the disc divided by the radius of the spot that is drawn.
    void disc(const Vec2& center, double radius, double z, Material material, double u = 0.0,
              double edge = 0.0);

    /// A ring in a plane; a blended material has the opacity u at its inner circle
    /// and 0 at the outer one. With `outside`, only the part outside that box.
    void ring(const Vec2& center, double inner, double outer, double z, Material material, double u = 0.0,
              const Bounds* outside = nullptr);

    /// The wall of a round hole, visible from inside, with its radii `above` and `below`. With `outside`,
    /// only the part outside that box.
    void well(const Vec2& center, double above, double below, double top, double bottom, Material material,
              const Bounds* outside = nullptr);

  private:
    MeshVertex vertex(const Vec3& p, const Vec3& n, double u, double v, Material material) const;
    void triangle(const MeshVertex& a, const MeshVertex& b, const MeshVertex& c);
    void fan(const Corners& corners);
    void add_outside(Corners corners, const Bounds* outside);

    TableMesh& mesh_;
};

/// Adds the marks of a preset; a custom outline has none.
/// rail: distance of the diamonds from the nose line [m].
void add_table_marks(const Table& table, TableMesh& mesh, MeshBuilder& builder, double rail);

}  // namespace carom::render
