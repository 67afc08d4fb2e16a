#include "stage/mesh_builder.h"

#include <Eigen/Geometry>
#include <cmath>
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
    const bool blend = is_blended(material);
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
    double along = 0.0;
    for (std::size_t i = 0; i < pieces; ++i) {
        const std::size_t j = (i + 1) % n;
        const Vec2 edge = outline.points[j] - outline.points[i];
        const double length = edge.norm();
        if (length == 0.0) continue;
        const Vec2 right = Vec2(edge.y(), -edge.x()) / length;
        for (std::size_t strip = 0; strip + 1 < rows.size(); ++strip) {
            const auto corner = [&](std::size_t row, std::size_t point, double where) {
                const double t = tilt(strip, row);
                const Vec3 normal = lift(right * std::sin(t), std::cos(t));
                const Vec3 p = lift(lines[row][point], outline.heights[point] + rows[row].z);
                const bool blend = is_blended(material);
                return vertex(p, normal, blend ? rows[row].opacity : where, blend ? 0.0 : rows[row].offset,
                              material);
            };
            const MeshVertex a = corner(strip, i, along), b = corner(strip, j, along + length);
            const MeshVertex c = corner(strip + 1, j, along + length), d = corner(strip + 1, i, along);
            triangle(a, b, c);
            triangle(a, c, d);
        }
        along += length;
    }
}

void MeshBuilder::disc(const Vec2& center, double inner, double outer, double z, Material material,
                       double u) {
    for (int i = 0; i < kCirclePieces; ++i) {
        quad(lift(on_circle(center, inner, i), z), lift(on_circle(center, outer, i), z),
             lift(on_circle(center, outer, i + 1), z), lift(on_circle(center, inner, i + 1), z), material, u);
    }
}

void MeshBuilder::well(const Vec2& center, double radius, double top, double bottom, Material material) {
    for (int i = 0; i < kCirclePieces; ++i) {
        const Vec2 a = on_circle(center, radius, i), b = on_circle(center, radius, i + 1);
        const Vec3 na = lift((center - a) / radius, 0.0), nb = lift((center - b) / radius, 0.0);
        const MeshVertex low_a = vertex(lift(a, bottom), na, 0.0, 1.0, material);
        const MeshVertex low_b = vertex(lift(b, bottom), nb, 0.0, 1.0, material);
        const MeshVertex top_a = vertex(lift(a, top), na, 0.0, 0.0, material);
        const MeshVertex top_b = vertex(lift(b, top), nb, 0.0, 0.0, material);
        triangle(low_a, low_b, top_b);
        triangle(low_a, top_b, top_a);
    }
}

}  // namespace carom::render
