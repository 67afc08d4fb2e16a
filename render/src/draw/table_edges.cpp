#include "draw/table_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

namespace carom::render {

namespace {

// Cosines of the largest angles between two triangles of one face, and of one plane.
constexpr double kOneFace = 0.94, kOnePlane = 0.999998;

struct Triangle {
    std::array<std::size_t, 3> corners;  // indices of welded positions
    Vec3 normal;
    bool flat;  // without area, so it is not drawn
};

Vec3 place(const MeshVertex& vertex) {
    return {vertex.x, vertex.y, vertex.z};
}

class EdgeFinder {
  public:
    explicit EdgeFinder(const TableMesh& table) : vertices_(table.solid), parents_(table.solid.size() / 3) {
        std::iota(parents_.begin(), parents_.end(), std::size_t{0});
        for (std::size_t i = 0; i + 2 < vertices_.size(); i += 3) add_triangle(i);
    }

    TableEdges find() {
        for (const auto& [ends, users] : edges_) {
            if (users.size() == 2 && one_face(users[0], users[1])) parents_[root(users[0])] = root(users[1]);
        }
        TableEdges found;
        mark_faces(found);
        for (const auto& [ends, users] : edges_) add_edge(found, ends, users);
        drop_doubled(found.edges);
        return found;
    }

    // The rims of the holes in the cloth, which the mesh does not have; the cloth is on their outer side.
    static void add_rim(TableEdges& found, const Hole& hole, const Vec2& origin) {
        constexpr int kPieces = 96;
        const auto at = [&](int piece, double radius) {
            const double angle = 2.0 * std::numbers::pi * piece / kPieces;
            const Vec2 p = hole.center - origin + radius * Vec2(std::cos(angle), std::sin(angle));
            return std::array<float, 3>{static_cast<float>(p.x()), static_cast<float>(p.y()), 0.0F};
        };
        for (int i = 0; i < kPieces; ++i) {
            found.edges.push_back({at(i, hole.radius),
                                   at(i + 1, hole.radius),
                                   {{{kClothFace, at(i, 1.5 * hole.radius)}, {}}},
                                   false});
        }
    }

  private:
    using Ends = std::pair<std::size_t, std::size_t>;

    std::size_t weld(const MeshVertex& vertex) {
        const auto grid = [](float value) { return std::lround(1e6 * value); };
        const auto key = std::make_tuple(grid(vertex.x), grid(vertex.y), grid(vertex.z));
        return welded_.emplace(key, welded_.size()).first->second;
    }

    void add_triangle(std::size_t first) {
        Triangle triangle{};
        for (std::size_t k = 0; k < 3; ++k) triangle.corners[k] = weld(vertices_[first + k]);
        const Vec3 a = place(vertices_[first]), b = place(vertices_[first + 1]),
                   c = place(vertices_[first + 2]);
        const Vec3 across = (b - a).cross(c - a);
        triangle.flat = !(across.norm() > 1e-12);
        triangle.normal = triangle.flat ? Vec3::UnitZ() : Vec3(across.normalized());
        if (!triangle.flat) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t i = triangle.corners[k], j = triangle.corners[(k + 1) % 3];
                if (i != j) edges_[std::minmax(i, j)].push_back(triangles_.size());
            }
        }
        triangles_.push_back(triangle);
    }

    const MeshVertex& vertex(std::size_t triangle, std::size_t corner) const {
        for (std::size_t k = 0; k < 2; ++k) {
            if (triangles_[triangle].corners[k] == corner) return vertices_[3 * triangle + k];
        }
        return vertices_[3 * triangle + 2];
    }

    bool one_face(std::size_t a, std::size_t b) const {
        const float material = vertices_[3 * a].material;
        if (material != vertices_[3 * b].material) return false;
        if (std::abs(triangles_[a].normal.dot(triangles_[b].normal)) < kOneFace) return false;
        if (static_cast<Material>(static_cast<int>(material)) != Material::kWood) return true;
        // Boards in one plane have different grain.
        for (const std::size_t corner : triangles_[a].corners) {
            const MeshVertex &here = vertex(a, corner), &there = vertex(b, corner);
            if (place(here).isApprox(place(there)) && std::hypot(here.u - there.u, here.v - there.v) > 1e-3)
                return false;
        }
        return true;
    }

    std::size_t root(std::size_t triangle) {
        while (parents_[triangle] != triangle) {
            parents_[triangle] = parents_[parents_[triangle]];
            triangle = parents_[triangle];
        }
        return triangle;
    }

    void mark_faces(TableEdges& found) {
        std::map<std::size_t, std::uint8_t> marks;
        for (std::size_t i = 0; i < triangles_.size(); ++i) {
            const bool cloth = vertices_[3 * i].material == static_cast<float>(Material::kCloth);
            const auto next = static_cast<std::uint8_t>(1 + marks.size() % kLastFace);
            found.faces.push_back(cloth ? kClothFace : marks.emplace(root(i), next).first->second);
        }
    }

    void add_edge(TableEdges& found, const Ends& ends, const std::vector<std::size_t>& users) {
        TableEdge edge;
        const auto floats = [](const MeshVertex& v) { return std::array<float, 3>{v.x, v.y, v.z}; };
        edge.a = floats(vertex(users[0], ends.first));
        edge.b = floats(vertex(users[0], ends.second));
        for (std::size_t k = 0; k < std::min<std::size_t>(2, users.size()); ++k) {
            const std::size_t triangle = users[k];
            edge.sides[k].face = found.faces[triangle];
            for (const std::size_t corner : triangles_[triangle].corners) {
                if (corner != ends.first && corner != ends.second)
                    edge.sides[k].corner = floats(vertex(triangle, corner));
            }
        }
        if (users.size() == 2 && root(users[0]) == root(users[1])) {
            const double bend = std::abs(triangles_[users[0]].normal.dot(triangles_[users[1]].normal));
            if (bend > kOnePlane) return;
            edge.smooth = true;
        }
        found.edges.push_back(edge);
    }

    // Where a cushion ends at the wood, both have an edge, and a pixel would be smoothed twice: the part of a
    // line that lies within a longer edge is dropped.
    static void drop_doubled(std::vector<TableEdge>& edges) {
        const auto point = [](const std::array<float, 3>& p) { return Vec3(p[0], p[1], p[2]); };
        constexpr double kLong = 0.2, kSame = 1e-5;  // [m]
        struct Long {
            Vec3 from, along;
            double length;
        };
        std::vector<Long> longest;
        // For each cell of the table, the long edges that may come near it, so that an edge is compared with
        // few of them.
        double size = 0.0;
        for (const TableEdge& edge : edges) size = std::max(size, point(edge.a).cwiseAbs().maxCoeff());
        const double side = std::max(0.25, size / 32.0);
        std::map<std::pair<int, int>, std::vector<std::size_t>> near;
        const auto cell = [&](double x) { return static_cast<int>(std::floor(x / side)); };
        for (const TableEdge& edge : edges) {
            const Vec3 from = point(edge.a), to = point(edge.b);
            if (edge.smooth || !((to - from).norm() > kLong)) continue;
            const Vec3 low = from.cwiseMin(to), high = from.cwiseMax(to);
            for (int i = cell(low.x() - kSame); i <= cell(high.x() + kSame); ++i) {
                for (int j = cell(low.y() - kSame); j <= cell(high.y() + kSame); ++j)
                    near[{i, j}].push_back(longest.size());
            }
            longest.push_back({from, to - from, (to - from).norm()});
        }
        const auto within = [&](const Vec3& p, const Long& edge) {
            const double t = std::clamp((p - edge.from).dot(edge.along) / edge.along.squaredNorm(), 0.0, 1.0);
            return (p - edge.from - t * edge.along).norm() < kSame;
        };
        std::erase_if(edges, [&](const TableEdge& edge) {
            const Vec3 a = point(edge.a), b = point(edge.b);
            const auto here = near.find({cell(a.x()), cell(a.y())});
            const double length = (b - a).norm();
            return here != near.end() &&
                   std::any_of(here->second.begin(), here->second.end(), [&](std::size_t i) {
                       return longest[i].length > length + kSame && within(a, longest[i]) &&
                              within(b, longest[i]);
                   });
        });
    }

    const std::vector<MeshVertex>& vertices_;
    std::map<std::tuple<long, long, long>, std::size_t> welded_;
    std::map<Ends, std::vector<std::size_t>> edges_;  // and the triangles at each
    std::vector<Triangle> triangles_;
    std::vector<std::size_t> parents_;
};

}  // namespace

TableEdges find_edges(const TableMesh& table) {
    TableEdges found = EdgeFinder(table).find();
    for (const Hole& hole : table.holes) EdgeFinder::add_rim(found, hole, table.origin);
    return found;
}

}  // namespace carom::render
