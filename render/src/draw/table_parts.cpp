#include "draw/table_parts.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "carom/render/mesh_cut.h"
#include "draw/shader_numbers.h"

namespace carom::render {

namespace {

// [-] With more holes than this, the mesh is not cut. Every cut goes through the whole table, so that
// neighbouring triangles still share their corners, and there would be too many pieces.
constexpr std::size_t kMostCutHoles = 16;

class PartSorter {
  public:
    explicit PartSorter(const TableMesh& table) {
        for (const Hole& hole : table.holes) {
            if (squares_.size() == shaders::kMaxHoles) break;
            const Vec2 center = hole.center - table.origin;
            const auto f = [](double value) { return static_cast<float>(value); };
            const double r = 1.001 * hole.radius;
            squares_.push_back({f(center.x() - r), f(center.y() - r), f(center.x() + r), f(center.y() + r)});
        }
        if (squares_.size() > kMostCutHoles) return;
        for (const Square& square : squares_) {
            lines_[0].insert(lines_[0].end(), {square.x0, square.x1});
            lines_[1].insert(lines_[1].end(), {square.y0, square.y1});
        }
    }

    void add(const MeshVertex* triangle, float face) {
        const auto material = static_cast<Material>(static_cast<int>(triangle->material));
        const auto [whole, cut] = parts_of(material);
        if (whole == cut || squares_.empty()) {
            put({triangle[0], triangle[1], triangle[2]}, whole, face);
            return;
        }
        std::vector<Corners> pieces{{triangle[0], triangle[1], triangle[2]}};
        for (const Axis axis : {Axis::kX, Axis::kY}) {
            for (const float at : lines_[axis == Axis::kX ? 0 : 1]) {
                std::vector<Corners> next;
                for (const Corners& piece : pieces) {
                    auto [below, above] = render::cut(piece, axis, at);
                    if (!below.empty()) next.push_back(std::move(below));
                    if (!above.empty()) next.push_back(std::move(above));
                }
                pieces = std::move(next);
            }
        }
        for (const Corners& piece : pieces) put(piece, meets_hole(piece) ? cut : whole, face);
    }

    TableParts sorted() const {
        TableParts result;
        for (std::size_t i = 0; i < kPartCount; ++i) {
            result.vertices.insert(result.vertices.end(), vertices_[i].begin(), vertices_[i].end());
            result.ends[i] = result.vertices.size();
        }
        return result;
    }

  private:
    struct Square {
        float x0, y0, x1, y1;
    };

    // The part of a triangle away from the holes, and at a hole.
    static std::pair<Part, Part> parts_of(Material material) {
        switch (material) {
            case Material::kCloth:
            case Material::kCushion:
                return {Part::kCloth, Part::kCutCloth};
            case Material::kWood:
                return {Part::kWood, Part::kCutWood};
            case Material::kFloor:
                return {Part::kFloor, Part::kFloor};
            case Material::kWall:
            case Material::kLamp:
                return {Part::kWall, Part::kWall};
            case Material::kShade:
                return {Part::kShade, Part::kCutShade};
            case Material::kChalk:
                return {Part::kChalk, Part::kChalk};
            case Material::kPocket:
            case Material::kTrim:
            case Material::kInlay:
                break;
        }
        return {Part::kSmall, Part::kSmall};
    }

    bool meets_hole(const Corners& piece) const {
        float x0 = piece[0].x, x1 = x0, y0 = piece[0].y, y1 = y0;
        for (const MeshVertex& corner : piece) {
            x0 = std::min(x0, corner.x);
            x1 = std::max(x1, corner.x);
            y0 = std::min(y0, corner.y);
            y1 = std::max(y1, corner.y);
        }
        // A piece next to a square has a side on its border, but nothing more.
        return std::any_of(squares_.begin(), squares_.end(), [&](const Square& square) {
            return x0 < square.x1 && square.x0 < x1 && y0 < square.y1 && square.y0 < y1;
        });
    }

    void put(const Corners& piece, Part part, float face) {
        auto& list = vertices_[static_cast<std::size_t>(part)];
        for (std::size_t i = 2; i < piece.size(); ++i)
            list.insert(list.end(), {{piece[0], face}, {piece[i - 1], face}, {piece[i], face}});
    }

    std::vector<Square> squares_;
    std::array<std::vector<float>, 2> lines_;  // values of x and of y
    std::array<std::vector<PartVertex>, kPartCount> vertices_;
};

}  // namespace

TableParts sort_parts(const TableMesh& table, const std::vector<std::uint8_t>& faces) {
    PartSorter sorter(table);
    for (std::size_t i = 0; i + 2 < table.solid.size(); i += 3) {
        const bool cloth = table.solid[i].material == static_cast<float>(Material::kCloth);
        const int face = faces.empty() ? (cloth ? 255 : 0) : faces[i / 3];
        sorter.add(&table.solid[i], static_cast<float>(face) / 255.0F);
    }
    // These do not write the fourth channel, or are painted on the playing surface.
    for (std::size_t i = 0; i + 2 < table.blended.size(); i += 3) sorter.add(&table.blended[i], 1.0F);
    return sorter.sorted();
}

}  // namespace carom::render
