// What a picture shows over the table: enough to tell which pixels of two pictures can differ, so that a
// frame costs what moved in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "carom/render/draw_list.h"

namespace carom::render {

/// What the ball shaders read, one per ball.
struct BallInstance {
    float center_radius[4];
    float orientation[4];
    float color_number[4];
    float pattern[3];  ///< pattern, in pocket, distance from the eye

    bool operator==(const BallInstance&) const = default;
};

/// Columns x0..x1-1 and rows y0..y1-1.
struct PixelBox {
    int x0, y0, x1, y1;

    bool operator==(const PixelBox&) const = default;
    bool meets(const PixelBox& other) const {
        return x0 < other.x1 && other.x0 < x1 && y0 < other.y1 && other.y0 < y1;
    }
};

struct DrawnBall {
    BallInstance instance;
    PixelBox box;        ///< pixels that it and its shadow may touch
    bool plain = false;  ///< nothing but cloth in its box, nor in that of a ball it meets

    bool operator==(const DrawnBall&) const = default;
};

/// Stands for one drawing of the table: pictures that share it show the same table.
struct TableDrawing {};

/// One picture: which table lies under it, and what is over it.
struct DrawnPicture {
    std::shared_ptr<const TableDrawing> table;  ///< which drawing of it; nothing: none
    bool overlay = false;                       ///< lines and boxes reach anywhere
    std::vector<DrawnBall> balls;               ///< far ones first, as they are drawn
};

/// Where nothing but cloth is seen, by squares of pixels.
class ClothMap {
  public:
    ClothMap() = default;
    /// @param rgba  rows of the table's picture; alpha 255 is a pixel that is all cloth
    ClothMap(const std::vector<std::uint8_t>& rgba, FrameSize size);
    bool all_cloth(const PixelBox& box) const;

  private:
    std::size_t place(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(column);
    }

    static constexpr int kSide = 16;  // pixels
    int columns_ = 0;
    std::vector<bool> cloth_;
};

/// The balls of a list that can be seen, and their boxes.
std::vector<DrawnBall> visible_balls(const DrawList& list, const ClothMap& cloth);

/// Boxes outside of which the two pictures are the same; the whole image where no more is known.
std::vector<PixelBox> differing_boxes(const DrawnPicture& before, const DrawnPicture& after, FrameSize size);

/// Adds to the boxes those of all balls that they meet, until none is left that is in part inside: what must
/// be drawn to fill the boxes anew. Returns which balls that are.
std::vector<bool> balls_inside(const std::vector<DrawnBall>& balls, std::vector<PixelBox>& boxes);

}  // namespace carom::render
