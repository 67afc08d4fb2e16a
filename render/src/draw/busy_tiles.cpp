// Finds the parts of a picture that need more than one sample per pixel.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "draw/table_edges.h"

namespace carom::render {

namespace {

constexpr int kTile = 8;       // [pixels] small, because edges are thin
constexpr int kFewLevels = 3;  // [of 255] between neighbours in a tile that is not busy

struct ScreenPoint {
    float x, y, w;  // clip space; then pixels
};

class Tiles {
  public:
    explicit Tiles(FrameSize size)
        : size_(size),
          columns_((size.width + kTile - 1) / kTile),
          rows_((size.height + kTile - 1) / kTile),
          busy_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {}

    // Largest difference between bytes this far apart.
    static int contrast(const std::uint8_t* bytes, std::size_t count, std::size_t farther) {
        std::uint8_t most = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint8_t a = bytes[i], b = bytes[i + farther];
            most = std::max(most, static_cast<std::uint8_t>(std::max(a, b) - std::min(a, b)));
        }
        return most;
    }

    void look_at(const std::vector<std::uint8_t>& rgba) {
        const std::size_t row_bytes = std::size_t{4} * static_cast<std::size_t>(size_.width);
        for (int y = 0; y < size_.height; ++y) {
            for (int column = 0; column < columns_; ++column) {
                const int x = column * kTile, right = std::min(x + kTile, size_.width);
                const std::uint8_t* bytes = rgba.data() + static_cast<std::size_t>(y) * row_bytes +
                                            std::size_t{4} * static_cast<std::size_t>(x);
                const auto count = static_cast<std::size_t>(right - x) * 4;
                const bool last = right == size_.width;  // no neighbour on its right
                if (contrast(bytes, last ? count - 4 : count, 4) > kFewLevels) {
                    mark(column, y / kTile);
                    if (!last) mark(column + 1, y / kTile);
                }
                if (y + 1 < size_.height && contrast(bytes, count, row_bytes) > kFewLevels) {
                    mark(column, y / kTile);
                    mark(column, (y + 1) / kTile);
                }
            }
        }
    }

    void look_at(const std::vector<TableEdge>& edges, const View& view) {
        for (const TableEdge& edge : edges) {
            // Contrast shows where a curved surface turns away from the eye.
            if (!edge.smooth) mark_line(project(edge.a, view), project(edge.b, view), view);
        }
    }

    // Chalk lines are thin, and not edges of the mesh.
    void look_at_chalk(const std::vector<MeshVertex>& triangles, const View& view) {
        for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
            if (triangles[i].material != static_cast<float>(Material::kChalk)) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const MeshVertex &a = triangles[i + k], &b = triangles[i + (k + 1) % 3];
                mark_line(project({a.x, a.y, a.z}, view), project({b.x, b.y, b.z}, view), view);
            }
        }
    }

    std::vector<PixelBox> boxes() const {
        std::vector<PixelBox> boxes;
        for (int y = 0; y < rows_; ++y) {
            for (int x = 0; x < columns_; ++x) {
                if (busy_[place(x, y)] == 0) continue;
                const int right = std::min((x + 1) * kTile, size_.width);
                if (x > 0 && busy_[place(x - 1, y)] != 0)
                    boxes.back().x1 = right;
                else
                    boxes.push_back({x * kTile, y * kTile, right, std::min((y + 1) * kTile, size_.height)});
            }
        }
        return boxes;
    }

  private:
    std::size_t place(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(column);
    }
    static ScreenPoint project(const std::array<float, 3>& p, const View& view) {
        const float* m = view.view_projection;
        const auto row = [&](int r) { return m[r] * p[0] + m[r + 4] * p[1] + m[r + 8] * p[2] + m[r + 12]; };
        return {row(0), row(1), row(3)};
    }

    // Marks everything within a pixel of a line.
    void mark_line(ScreenPoint a, ScreenPoint b, const View& view) {
        const float near = view.planes[0];
        if (std::max(a.w, b.w) <= near) return;
        const auto to_near = [near](ScreenPoint& behind, const ScreenPoint& front) {
            if (behind.w >= near) return;
            const float share = (near - behind.w) / (front.w - behind.w);
            behind = {behind.x + share * (front.x - behind.x), behind.y + share * (front.y - behind.y), near};
        };
        to_near(a, b);
        to_near(b, a);
        const float ax = (0.5F + 0.5F * a.x / a.w) * view.size[0],
                    ay = (0.5F + 0.5F * a.y / a.w) * view.size[1];
        const float dx = (0.5F + 0.5F * b.x / b.w) * view.size[0] - ax,
                    dy = (0.5F + 0.5F * b.y / b.w) * view.size[1] - ay;
        // The part of the line that is in the picture, as fractions of its length.
        float from = 0.0F, to = 1.0F;
        const auto clip = [&](float start, float step, float limit) {
            constexpr float kBeyond = 4.0F;  // [pixels]
            if (step == 0.0F) {
                if (start < -kBeyond || start > limit + kBeyond) to = -1.0F;
                return;
            }
            const float s = (-kBeyond - start) / step, t = (limit + kBeyond - start) / step;
            from = std::max(from, std::min(s, t));
            to = std::min(to, std::max(s, t));
        };
        clip(ax, dx, view.size[0]);
        clip(ay, dy, view.size[1]);
        if (!(from <= to)) return;
        // Boxes around points of the line, close enough to leave nothing out.
        constexpr float kStep = 4.0F, kAround = 0.5F * kStep + 1.0F;  // [pixels]
        const int steps = static_cast<int>(std::max(std::abs(dx), std::abs(dy)) * (to - from) / kStep) + 1;
        for (int i = 0; i <= steps; ++i) {
            const float share = from + (to - from) * (static_cast<float>(i) / static_cast<float>(steps));
            mark_around(ax + share * dx, ay + share * dy, kAround);
        }
    }

    void mark_around(float x, float y, float around) {
        const auto tile = [](float at, int limit) {
            return std::clamp(static_cast<int>(std::floor(at / kTile)), 0, limit - 1);
        };
        for (int row = tile(y - around, rows_); row <= tile(y + around, rows_); ++row) {
            for (int column = tile(x - around, columns_); column <= tile(x + around, columns_); ++column)
                mark(column, row);
        }
    }

    void mark(int column, int row) { busy_[place(column, row)] = 1; }

    FrameSize size_;
    int columns_, rows_;
    std::vector<std::uint8_t> busy_;
};

}  // namespace

std::vector<PixelBox> busy_tiles(const std::vector<std::uint8_t>& rgba, FrameSize size,
                                 const TableMesh& table, const View& view) {
    Tiles tiles(size);
    tiles.look_at(rgba);
    tiles.look_at(find_edges(table).edges, view);
    tiles.look_at_chalk(table.blended, view);
    return tiles.boxes();
}

}  // namespace carom::render
