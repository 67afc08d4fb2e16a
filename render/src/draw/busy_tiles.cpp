#include "draw/busy_tiles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace carom::render {

namespace {

constexpr int kTile = 32;      // [pixels]
constexpr int kFewLevels = 3;  // [of 255] between neighbours in a tile that is not busy
constexpr float kThinnest =
    1.5F;  // [pixels] A triangle that is thinner, upright or level, may lie between the samples

class Tiles {
  public:
    explicit Tiles(FrameSize size)
        : size_(size),
          columns_((size.width + kTile - 1) / kTile),
          rows_((size.height + kTile - 1) / kTile),
          busy_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {}

    // Greatest difference of the bytes from those that are so many bytes farther on.
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

    void look_at(const std::vector<MeshVertex>& triangles, const View& view) {
        for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
            float low_x = 1e9F, low_y = 1e9F, high_x = -1e9F, high_y = -1e9F;
            bool in_front = true;
            for (std::size_t k = i; k < i + 3; ++k) {
                const float* m = view.view_projection;
                const MeshVertex& v = triangles[k];
                const auto row = [&](int r) {
                    return m[r] * v.x + m[r + 4] * v.y + m[r + 8] * v.z + m[r + 12];
                };
                in_front = in_front && row(3) > view.planes[0];
                const float x = (0.5F + 0.5F * row(0) / row(3)) * view.size[0],
                            y = (0.5F + 0.5F * row(1) / row(3)) * view.size[1];
                low_x = std::min(low_x, x);
                high_x = std::max(high_x, x);
                low_y = std::min(low_y, y);
                high_y = std::max(high_y, y);
            }
            // One that is partly behind the eye comes near it, and is not thin.
            if (!in_front || std::min(high_x - low_x, high_y - low_y) >= kThinnest) continue;
            const auto tile = [](float at, int limit) {
                return static_cast<int>(std::clamp(at / kTile, -1.0F, static_cast<float>(limit)));
            };
            for (int y = std::max(0, tile(low_y - 1.0F, rows_));
                 y <= std::min(rows_ - 1, tile(high_y + 1.0F, rows_)); ++y) {
                for (int x = std::max(0, tile(low_x - 1.0F, columns_));
                     x <= std::min(columns_ - 1, tile(high_x + 1.0F, columns_)); ++x)
                    mark(x, y);
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
    tiles.look_at(table.solid, view);
    tiles.look_at(table.blended, view);
    return tiles.boxes();
}

}  // namespace carom::render
