#include "stage/mesh_builder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace carom::render {

namespace {
constexpr double kTau = 6.28318530717958647692;  // [rad] full circle
constexpr int kCirclePieces = 96;                // [-] straight pieces of a drawn circle

bool is_blended(Material material) {
    return material == Material::kShade || material == Material::kChalk;
}

Vec2 on_circle(const Vec2& center, double radius, int piece) {
    const double angle = kTau * piece / kCirclePieces;
    return center + radius * Vec2(std::cos(angle), std::sin(angle));
}

Vec3 lift(const Vec2& p, double z) {
    return {p.x(), p.y(), z};
}
}  // namespace

MeshVertex MeshBuilder::vertex(const Vec3& p, const Vec3& n, double u, double v, Material material) const {
    const auto f = [](double value) { return static_cast<float>(value); };
    return {f(p.x() - mesh_.origin.x()),
            f(p.y() - mesh_.origin.y()),
            f(p.z()),
            f(n.x()),
            f(n.y()),
            f(n.z()),
            f(u),
            f(v),
            static_cast<float>(material)};
}

void MeshBuilder::triangle(const MeshVertex& a, const MeshVertex& b, const MeshVertex& c) {
    auto& list =
        is_blended(static_cast<Material>(static_cast<int>(a.material))) ? mesh_.blended : mesh_.solid;
    list.insert(list.end(), {a, b, c});
}

void MeshBuilder::quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, Material material,
                       double u) {
    const Vec3 normal = (c - a).cross(d - b).normalized();
    const double length = (b - a).norm(), width = (d - a).norm();
    const bool blend = is_blended(material) || material == Material::kLamp;  // u is not a coordinate
    const MeshVertex va = vertex(a, normal, u, 0.0, material),
                     vb = vertex(b, normal, blend ? u : length, 0.0, material);
    const MeshVertex vc = vertex(c, normal, blend ? u : length, width, material);
    const MeshVertex vd = vertex(d, normal, u, width, material);
    triangle(va, vb, vc);
    triangle(va, vc, vd);
}

void MeshBuilder::polygon(const std::vector<Vec2>& outline, double z, Material material) {
    const std::vector<int> corners = triangulate(outline);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        const auto at = [&](std::size_t k) {
            const Vec2& p = outline[corners[i + k]];
            return vertex(lift(p, z), Vec3::UnitZ(), p.x(), p.y(), material);
        };
        triangle(at(0), at(1), at(2));
    }
}

void MeshBuilder::sweep(const Chain& outline, const std::vector<ProfileRow>& rows, Material material,
                        bool smooth) {
    const std::size_t n = outline.points.size(), pieces = outline.closed ? n : n - 1;
    std::vector<std::vector<Vec2>> lines;
    lines.reserve(rows.size());
    for (const ProfileRow& row : rows)
        lines.push_back(offset_left(outline.points, outline.closed, row.offset));
    // Angle of the profile's normal from the vertical towards the right-hand (playing) side, for each strip.
    const auto slope = [&](std::size_t row) {
        const double along = rows[row + 1].offset - rows[row].offset, up = rows[row + 1].z - rows[row].z;
        return std::atan2(up, along);
    };
    const auto tilt = [&](std::size_t strip, std::size_t row) {
        if (!smooth) return slope(strip);
        const std::size_t before = row == 0 ? 0 : row - 1, after = row + 1 == rows.size() ? row - 1 : row;
        return 0.5 * (slope(before) + slope(after));
    };
    // The grain of wood restarts at each corner sharper than 20 degrees, which makes a mitre there.
    constexpr double kMitre = 0.94, kOtherBoard = 0.617;  // cosine; m of grain between two boards
    double along = 0.0, board = 0.0;
    Vec2 before = Vec2::Zero();
    for (std::size_t i = 0; i < pieces; ++i) {
        const std::size_t j = (i + 1) % n;
        const Vec2 edge = outline.points[j] - outline.points[i];
        const double length = edge.norm();
        if (length == 0.0) continue;
        const Vec2 right = Vec2(edge.y(), -edge.x()) / length;
        if (edge.dot(before) < kMitre * length * before.norm()) board += kOtherBoard;
        before = edge;
        for (std::size_t strip = 0; strip + 1 < rows.size(); ++strip) {
            const auto corner = [&](std::size_t row, std::size_t point) {
                const double t = tilt(strip, row);
                const Vec3 normal = lift(right * std::sin(t), std::cos(t));
                const Vec3 p = lift(lines[row][point], outline.heights[point] + rows[row].z);
                if (is_blended(material))
                    return vertex(p, normal, rows[row].opacity, rows[row].across, material);
                const double where = along + (lines[row][point] - outline.points[i]).dot(edge) / length;
                return vertex(p, normal, where + board, rows[row].offset - rows[row].z + board, material);
            };
            const MeshVertex a = corner(strip, i), b = corner(strip, j);
            const MeshVertex c = corner(strip + 1, j), d = corner(strip + 1, i);
            triangle(a, b, c);
            triangle(a, c, d);
        }
        along += length;
    }
}

void MeshBuilder::disc(const Vec2& center, double radius, double z, Material material, double u,
                       double edge) {
    const MeshVertex middle = vertex(lift(center, z), Vec3::UnitZ(), u, 0.0, material);
    for (int i = 0; i < kCirclePieces; ++i) {
        const auto rim = [&](int piece) {
            return vertex(lift(on_circle(center, radius, piece), z), Vec3::UnitZ(), u, edge, material);
        };
        triangle(middle, rim(i), rim(i + 1));
    }
}

void MeshBuilder::fan(const Corners& corners) {
    for (std::size_t i = 2; i < corners.size(); ++i) triangle(corners[0], corners[i - 1], corners[i]);
}

void MeshBuilder::add_outside(Corners corners, const Bounds* outside) {
    if (outside == nullptr) {
        fan(corners);
        return;
    }
    const auto f = [](double value) { return static_cast<float>(value); };
    const Vec2 low = outside->low - mesh_.origin, high = outside->high - mesh_.origin;
    for (const Axis axis : {Axis::kX, Axis::kY}) {
        const int i = axis == Axis::kX ? 0 : 1;
        auto [below, rest] = cut(corners, axis, f(low[i]));
        auto [inside, above] = cut(rest, axis, f(high[i]));
        fan(below);
        fan(above);
        corners = std::move(inside);
    }
}

void MeshBuilder::ring(const Vec2& center, double inner, double outer, double z, Material material, double u,
                       const Bounds* outside) {
    for (int i = 0; i < kCirclePieces; ++i) {
        // The leather of a rim is rolled inwards.
        const auto corner = [&](double radius, int piece, double opacity) {
            const Vec2 p = on_circle(center, radius, piece);
            const double roll = is_blended(material) ? 0.0 : (radius == inner ? -0.9 : 0.5);
            return vertex(lift(p, z), lift((p - center) * (roll / radius), 1.0).normalized(), opacity, 0.0,
                          material);
        };
        add_outside(
            {corner(inner, i, u), corner(outer, i, 0.0), corner(outer, i + 1, 0.0), corner(inner, i + 1, u)},
            outside);
    }
}

void MeshBuilder::well(const Vec2& center, double above, double below, double top, double bottom,
                       Material material, const Bounds* outside) {
    for (int i = 0; i < kCirclePieces; ++i) {
        const auto corner = [&](double z, int piece) {
            const double radius = z == top ? above : below;
            const Vec2 p = on_circle(center, radius, piece);
            return vertex(lift(p, z), lift((center - p) / radius, 0.0), 0.0, z == top ? 0.0 : 1.0, material);
        };
        add_outside({corner(bottom, i), corner(bottom, i + 1), corner(top, i + 1), corner(top, i)}, outside);
    }
}

}  // namespace carom::render
