#include "page/table_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;
using render::Material;
using render::MeshVertex;
using render::TableMesh;

// [m] Corners are rounded to this: far below a pixel, far above the rounding of the mesh's floats.
constexpr double kGrid = 1e-5;
// [m] Largest distance by which simplifying may move an outline.
constexpr double kSimplify = 1.5e-4;
// [m^2] Triangles that look smaller from above are walls, or face away.
constexpr double kLeastArea = 1e-9;

// The most by which the gradients of one board's triangles differ; boards begin 0.6 m of grain apart.
constexpr double kSameGrain = 0.05;

using Corner = std::pair<std::int64_t, std::int64_t>;  // in units of kGrid, relative to the mesh's origin
using Outline = std::vector<Corner>;
using Triangle = std::array<MeshVertex, 3>;

Corner corner(const MeshVertex& v) {
    return {std::llround(v.x / kGrid), std::llround(v.y / kGrid)};
}

double area_from_above(const MeshVertex& a, const MeshVertex& b, const MeshVertex& c) {
    return 0.5 *
           (static_cast<double>(b.x - a.x) * (c.y - a.y) - static_cast<double>(b.y - a.y) * (c.x - a.x));
}

bool is(const MeshVertex& v, Material material) {
    return v.material == static_cast<float>(material);
}

double distance_from(const Corner& p, const Corner& a, const Corner& b) {
    const auto along_x = static_cast<double>(b.first - a.first),
               along_y = static_cast<double>(b.second - a.second);
    const auto x = static_cast<double>(p.first - a.first), y = static_cast<double>(p.second - a.second);
    const double length = std::hypot(along_x, along_y);
    return kGrid * (length > 0.0 ? std::abs(along_x * y - along_y * x) / length : std::hypot(x, y));
}

/// Appends the points after `from` up to `to` that keep the outline within kSimplify (Douglas-Peucker).
void append_needed(const Outline& all, std::size_t from, std::size_t to, Outline& kept) {
    std::size_t farthest = from;
    double most = kSimplify;
    for (std::size_t i = from + 1; i < to; ++i) {
        const double away = distance_from(all[i], all[from], all[to % all.size()]);
        if (away > most) {
            most = away;
            farthest = i;
        }
    }
    if (farthest != from) {
        append_needed(all, from, farthest, kept);
        append_needed(all, farthest, to, kept);
    } else {
        kept.push_back(all[to % all.size()]);
    }
}

/// The outlines of all triangles together: an edge that two of them share, in opposite directions, is inside.
std::vector<Outline> outlines(const std::vector<Triangle>& triangles) {
    std::map<std::pair<Corner, Corner>, int> edges;
    for (const Triangle& t : triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Corner a = corner(t[i]), b = corner(t[(i + 1) % 3]);
            if (a == b) continue;
            const auto opposite = edges.find({b, a});
            if (opposite == edges.end())
                ++edges[{a, b}];
            else if (--opposite->second == 0)
                edges.erase(opposite);
        }
    }
    std::multimap<Corner, Corner> next;
    for (const auto& [edge, count] : edges)
        for (int i = 0; i < count; ++i) next.insert(edge);
    std::vector<Outline> all;
    while (!next.empty()) {
        Outline whole;
        for (auto edge = next.begin(); edge != next.end(); edge = next.find(whole.back())) {
            if (whole.empty()) whole.push_back(edge->first);
            whole.push_back(edge->second);
            next.erase(edge);
            if (whole.back() == whole.front()) break;
        }
        whole.pop_back();
        if (whole.size() < 3) continue;
        // Both halves are simplified, between two corners that stay.
        Outline kept;
        const std::size_t middle = whole.size() / 2;
        append_needed(whole, 0, middle, kept);
        append_needed(whole, middle, whole.size(), kept);
        if (kept.size() >= 3) all.push_back(std::move(kept));
    }
    return all;
}

/// A number in m on the grid, as short as it can be written.
double metres(double x) {
    return std::round(x / kGrid) / std::round(1.0 / kGrid);
}

Json place(const Vec2& p) {
    return {metres(p.x()), metres(p.y())};
}

Json loops_json(const TableMesh& mesh, const std::vector<Triangle>& triangles) {
    Json list = Json::array();
    for (const Outline& outline : outlines(triangles)) {
        Json loop = Json::array();
        for (const auto& [x, y] : outline) {
            loop.push_back(metres(mesh.origin.x() + kGrid * static_cast<double>(x)));
            loop.push_back(metres(mesh.origin.y() + kGrid * static_cast<double>(y)));
        }
        list.push_back(std::move(loop));
    }
    return list;
}

/// The triangles of a material that are visible from above.
std::vector<Triangle> seen_from_above(const std::vector<MeshVertex>& vertices, Material material) {
    std::vector<Triangle> list;
    for (std::size_t i = 0; i + 2 < vertices.size(); i += 3)
        if (is(vertices[i], material) &&
            area_from_above(vertices[i], vertices[i + 1], vertices[i + 2]) > kLeastArea)
            list.push_back({vertices[i], vertices[i + 1], vertices[i + 2]});
    return list;
}

/// The pieces between v = -1 and 1, the edges of a mark.
std::vector<Triangle> within_marks(const std::vector<Triangle>& triangles) {
    std::vector<Triangle> list;
    for (const Triangle& t : triangles) {
        std::vector<MeshVertex> polygon(t.begin(), t.end());
        for (const float side : {1.0F, -1.0F}) {
            std::vector<MeshVertex> cut;
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const MeshVertex &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
                const float past_a = side * a.v - 1.0F, past_b = side * b.v - 1.0F;
                if (past_a <= 0.0F) cut.push_back(a);
                if ((past_a <= 0.0F) == (past_b <= 0.0F)) continue;
                const float share = past_a / (past_a - past_b);
                MeshVertex on = a;
                on.x += share * (b.x - a.x);
                on.y += share * (b.y - a.y);
                on.v = side;
                cut.push_back(on);
            }
            polygon = std::move(cut);
        }
        for (std::size_t i = 2; i < polygon.size(); ++i)
            list.push_back({polygon[0], polygon[i - 1], polygon[i]});
    }
    return list;
}

/// u or v of a triangle as g0 x + g1 y + g2, x and y relative to the mesh's origin.
std::array<double, 3> gradient(const Triangle& t, float MeshVertex::*value) {
    const double abx = t[1].x - t[0].x, aby = t[1].y - t[0].y, acx = t[2].x - t[0].x, acy = t[2].y - t[0].y;
    const double ab = t[1].*value - t[0].*value, ac = t[2].*value - t[0].*value,
                 twice = abx * acy - aby * acx;
    const double x = (ab * acy - ac * aby) / twice, y = (ac * abx - ab * acx) / twice;
    return {x, y, t[0].*value - x * t[0].x - y * t[0].y};
}

Json boards_json(const TableMesh& mesh) {
    struct Board {
        std::vector<Triangle> triangles;
        double largest = 0.0;
        std::array<double, 3> u{}, v{};
    };
    // Triangles with nearly the same grain form a board. Its bevels have that grain too; its largest triangle
    // is its flat top.
    std::vector<Board> boards;
    for (const Triangle& t : seen_from_above(mesh.solid, Material::kWood)) {
        const std::array<double, 3> u = gradient(t, &MeshVertex::u);
        const auto near = [](double a, double b) { return std::abs(a - b) < kSameGrain; };
        auto found = std::find_if(boards.begin(), boards.end(), [&](const Board& board) {
            return std::equal(u.begin(), u.end(), board.u.begin(), near);
        });
        if (found == boards.end()) found = boards.insert(found, Board{{}, 0.0, u, {}});
        Board& board = *found;
        board.triangles.push_back(t);
        const double area = area_from_above(t[0], t[1], t[2]);
        if (area <= board.largest) continue;
        board.largest = area;
        board.u = u;
        board.v = gradient(t, &MeshVertex::v);
    }
    Json list = Json::array();
    for (const Board& board : boards) {
        Json grain = Json::array();
        for (const auto& g : {board.u, board.v})
            for (const double x : {g[0], g[1], g[2] - g[0] * mesh.origin.x() - g[1] * mesh.origin.y()})
                grain.push_back(std::round(1e4 * x) / 1e4);
        list.push_back({{"loops", loops_json(mesh, board.triangles)}, {"grain", grain}});
    }
    return list;
}

}  // namespace

std::vector<std::array<MeshVertex, 3>> table_marks(const TableMesh& mesh) {
    return within_marks(seen_from_above(mesh.blended, Material::kChalk));
}

Json table_shape(const carom::Table& table, const TableMesh& mesh) {
    const auto loops = [&mesh](Material material) {
        return loops_json(mesh, seen_from_above(mesh.solid, material));
    };
    Json holes = Json::array();
    for (const render::Hole& hole : mesh.holes)
        holes.push_back({{"center", place(hole.center)}, {"radius", metres(hole.radius)}});
    Json numbers = Json::array();
    for (const auto& [at, number] : render::diamond_numbers(table, mesh))
        numbers.push_back({{"at", place(at)}, {"number", number}});
    const Vec3& lamp = mesh.lamp.center;
    return {{"bounds", {{"low", place(mesh.bounds.low)}, {"high", place(mesh.bounds.high)}}},
            {"inner", {{"low", place(mesh.inner_low)}, {"high", place(mesh.inner_high)}}},
            {"lamp",
             {{"center", {metres(lamp.x()), metres(lamp.y()), metres(lamp.z())}},
              {"half", place(mesh.lamp.half)},
              {"endless", mesh.lamp.endless}}},
            {"wood_top", metres(mesh.wood_top)},
            {"felt", mesh.cloth},
            {"cloth", loops(Material::kCloth)},
            {"cushion", loops(Material::kCushion)},
            {"trim", loops(Material::kTrim)},
            {"inlay", loops(Material::kInlay)},
            {"chalk", loops_json(mesh, table_marks(mesh))},
            {"wood", boards_json(mesh)},
            {"holes", holes},
            {"numbers", numbers}};
}

}  // namespace carom::tools
