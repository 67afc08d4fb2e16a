// The table as indexed triangles, one list per material, for programs that do not know this renderer.
#include "commands/export/gltf.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "carom/render/mesh_cut.h"
#include "page/table_shape.h"

namespace carom::tools {
namespace {

using render::Corners;
using render::Material;
using render::MeshVertex;

constexpr int kHolePieces = 48;  // [-] straight pieces of a hole's edge, within 0.1 mm of the circle

MeshVertex between(const MeshVertex& a, const MeshVertex& b, float t) {
    MeshVertex c = a;
    for (float MeshVertex::*part : {&MeshVertex::x, &MeshVertex::y, &MeshVertex::z, &MeshVertex::nx,
                                    &MeshVertex::ny, &MeshVertex::nz, &MeshVertex::u, &MeshVertex::v})
        c.*part = a.*part + t * (b.*part - a.*part);
    return c;
}

/// Splits a convex polygon by the vertical plane x nx + y ny = d into its outer and inner part.
std::pair<Corners, Corners> split(const Corners& polygon, float nx, float ny, float d) {
    std::pair<Corners, Corners> parts;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const MeshVertex &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const float out_a = nx * a.x + ny * a.y - d, out_b = nx * b.x + ny * b.y - d;
        (out_a > 0.0F ? parts.first : parts.second).push_back(a);
        if ((out_a > 0.0F) == (out_b > 0.0F)) continue;
        // Interpolated from the outer end, so that two polygons with a common edge get the same corner on it.
        const MeshVertex on =
            out_a > 0.0F ? between(a, b, out_a / (out_a - out_b)) : between(b, a, out_b / (out_b - out_a));
        parts.first.push_back(on);
        parts.second.push_back(on);
    }
    return parts;
}

/// Appends the part outside the hole.
void cut_hole(const Corners& polygon, const render::Hole& hole, const Vec2& origin,
              std::vector<Corners>& kept) {
    const Vec2 center = hole.center - origin;
    const double reach = hole.radius * std::cos(std::numbers::pi / kHolePieces);
    Corners left = polygon;
    std::vector<Corners> outside;
    for (int i = 0; i < kHolePieces && left.size() >= 3; ++i) {
        const double angle = 2.0 * std::numbers::pi * (i + 0.5) / kHolePieces, x = std::cos(angle),
                     y = std::sin(angle);
        auto [out, in] = split(left, static_cast<float>(x), static_cast<float>(y),
                               static_cast<float>(center.x() * x + center.y() * y + reach));
        if (out.size() >= 3) outside.push_back(std::move(out));
        left = std::move(in);
    }
    // it does not reach into the hole
    if (left.size() < 3)
        kept.push_back(polygon);
    else
        kept.insert(kept.end(), outside.begin(), outside.end());
}

/// Merges vertices that agree to a micrometre, and whose normals agree to a thousandth.
class Indexed {
  public:
    void add(const Corners& polygon, TablePart& part) {
        std::vector<std::uint32_t> at;
        for (const MeshVertex& v : polygon) at.push_back(index_of(v, part));
        for (std::size_t i = 2; i < at.size(); ++i) {
            if (at[0] == at[i - 1] || at[0] == at[i] || at[i - 1] == at[i]) continue;
            part.indices.insert(part.indices.end(), {at[0], at[i - 1], at[i]});
        }
    }

  private:
    std::uint32_t index_of(const MeshVertex& v, TablePart& part) {
        const float length = std::sqrt(v.nx * v.nx + v.ny * v.ny + v.nz * v.nz);
        const float nx = v.nx / length, ny = v.ny / length, nz = v.nz / length;
        const auto grid = [](float x, double unit) {
            return static_cast<std::int64_t>(std::llround(x / unit));
        };
        const std::array<std::int64_t, 6> key{grid(v.x, 1e-6), grid(v.y, 1e-6), grid(v.z, 1e-6),
                                              grid(nx, 1e-3),  grid(ny, 1e-3),  grid(nz, 1e-3)};
        const auto [found, is_new] =
            known_.emplace(key, static_cast<std::uint32_t>(part.positions.size() / 3));
        if (is_new) {
            part.positions.insert(part.positions.end(), {v.x, v.z, -v.y});
            part.normals.insert(part.normals.end(), {nx, nz, -ny});
        }
        return found->second;
    }

    std::map<std::array<std::int64_t, 6>, std::uint32_t> known_;
};

bool has_holes(Material material) {
    return material == Material::kCloth || material == Material::kWood;
}

/// Cuts triangles along the sides of the squares around all holes, across the whole table, so that neighbours
/// still share their corners. Only pieces inside a square are then cut along the circle.
class HoleCutter {
  public:
    explicit HoleCutter(const render::TableMesh& mesh) : mesh_(mesh) {
        // More holes than the renderer cuts out would give too many pieces.
        if (mesh.holes.size() > kMostHoles) return;
        for (const render::Hole& hole : mesh.holes) {
            const Vec2 center = hole.center - mesh.origin;
            for (const int axis : {0, 1})
                for (const double side : {-1.0, 1.0})
                    lines_[static_cast<std::size_t>(axis)].push_back(
                        static_cast<float>(center[axis] + 1.001 * side * hole.radius));
        }
    }

    std::vector<Corners> cut(const Corners& triangle) const {
        std::vector<Corners> pieces{triangle};
        for (const render::Axis axis : {render::Axis::kX, render::Axis::kY}) {
            for (const float at : lines_[axis == render::Axis::kX ? 0 : 1]) {
                std::vector<Corners> next;
                for (const Corners& piece : pieces) {
                    auto [below, above] = render::cut(piece, axis, at);
                    if (below.size() >= 3) next.push_back(std::move(below));
                    if (above.size() >= 3) next.push_back(std::move(above));
                }
                pieces = std::move(next);
            }
        }
        for (const render::Hole& hole : mesh_.holes) {
            std::vector<Corners> kept;
            for (const Corners& piece : pieces) {
                if (meets(piece, hole))
                    cut_hole(piece, hole, mesh_.origin, kept);
                else
                    kept.push_back(piece);
            }
            pieces = std::move(kept);
        }
        return pieces;
    }

  private:
    static constexpr std::size_t kMostHoles = 16;

    bool meets(const Corners& piece, const render::Hole& hole) const {
        Vec2 middle = Vec2::Zero();
        for (const MeshVertex& v : piece) middle += Vec2(v.x, v.y) / static_cast<double>(piece.size());
        const Vec2 away = (middle + mesh_.origin - hole.center).cwiseAbs();
        return lines_[0].empty() || away.maxCoeff() < 1.001 * hole.radius;
    }

    const render::TableMesh& mesh_;
    std::array<std::vector<float>, 2> lines_;
};

bool has_area(const Corners& c) {
    const Vec3 a(c[0].x, c[0].y, c[0].z), b(c[1].x, c[1].y, c[1].z), d(c[2].x, c[2].y, c[2].z);
    constexpr double kLeast = 1e-10;  // [m^2] twice the area
    return (b - a).cross(d - a).norm() > kLeast && std::isfinite(c[0].nx + c[1].nx + c[2].nx);
}

}  // namespace

std::map<Material, TablePart> table_parts(const render::TableMesh& mesh) {
    std::map<Material, TablePart> parts;
    std::map<Material, Indexed> indexed;
    const HoleCutter cutter(mesh);
    const auto put = [&](const Corners& polygon, Material material) {
        indexed[material].add(polygon, parts[material]);
    };
    for (std::size_t i = 0; i + 2 < mesh.solid.size(); i += 3) {
        const auto material = static_cast<Material>(static_cast<int>(mesh.solid[i].material));
        const Corners triangle{mesh.solid[i], mesh.solid[i + 1], mesh.solid[i + 2]};
        const bool room =
            material == Material::kFloor || material == Material::kWall || material == Material::kLamp;
        if (room || !has_area(triangle)) continue;
        const std::vector<Corners> pieces =
            has_holes(material) ? cutter.cut(triangle) : std::vector<Corners>{triangle};
        for (const Corners& piece : pieces) put(piece, material);
    }
    for (const auto& mark : table_marks(mesh)) put({mark[0], mark[1], mark[2]}, Material::kChalk);
    for (auto part = parts.begin(); part != parts.end();)
        part = part->second.indices.empty() ? parts.erase(part) : std::next(part);
    return parts;
}

}  // namespace carom::tools
