// The balls of a picture. Comparing two pictures gives the pixels that can differ, so that the
// time of a frame depends only on what moved.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "carom/render/draw_list.h"
#include "carom/render/image.h"
#include "draw/shader_numbers.h"
#include "draw/table_edges.h"
#include "draw/view.h"

namespace carom::render {

struct DrawnShape {
    std::variant<DrawLine, DrawBox, DrawCue> what;
    PixelBox box;         ///< pixels that it may cover
    Vec2 from, to;        ///< the ends of a line [pixels]; for anything else, two corners of the box
    double reach = -1.0;  ///< [pixels] beyond the line between them; negative: the whole box
};

/// [m] More than the radius of a cue, and than half the width of its shadow.
inline constexpr double kCueReach = 0.016, kCueShadowReach = 0.06;

/// The cue of a list, its lines, then its boxes, in the order of drawing within each kind.
std::vector<DrawnShape> drawn_shapes(const DrawList& list);

/// Adds boxes outside which two lists of shapes look the same: those of shapes that are in only one of them,
/// or drawn in another order. A long line has several boxes.
void add_differing(const std::vector<DrawnShape>& before, const std::vector<DrawnShape>& after,
                   std::vector<PixelBox>& boxes);

enum class BallPlace : std::uint8_t {
    kCloth,
    kPocket,   ///< it casts no shadow
    kCushion,  ///< near a cushion, which also gets a shadow
};

/// The lamp as seen from the cloth below a ball: the slopes of the directions to its centre, and half their
/// ranges.
struct LampSlopes {
    float x, y, half_x, half_y;
    bool operator==(const LampSlopes&) const = default;
};

/// The look of a ball, in single precision.
struct BallInstance {
    float center_radius[4];
    float orientation[4];
    float color_number[4];
    float pattern[3];  ///< pattern, place (BallPlace), distance from the eye
    LampSlopes lamp;
    float near[shaders::kMaxNear][4];  ///< the nearest other balls: offset of the centre [m], weight 0..1
    float near_color[shaders::kMaxNear][3];  ///< their reflectances

    bool operator==(const BallInstance&) const = default;
};

struct DrawnBall {
    BallInstance instance;
    PixelBox box;        ///< pixels that the ball and its shadow may cover
    PixelBox body;       ///< pixels that the ball may cover
    PixelBox shadow;     ///< pixels that its shadow on the cloth may cover
    PixelBox beside;     ///< pixels of its surroundings that it darkens
    bool plain = false;  ///< its box shows only cloth, and nothing hides it

    bool operator==(const DrawnBall&) const = default;
};

/// The edges that are smoothed in a picture after it was read, under a camera that moves.
struct EdgesInView {
    std::shared_ptr<const TableEdges> table;
    View view;
    std::vector<PixelBox> skip;  ///< panels with text
};

/// Identifies one drawing of the table: pictures that share the pointer show the same table.
struct TableDrawing {};

/// One picture: the drawing of the table, and what was drawn over it.
struct DrawnPicture {
    std::shared_ptr<const TableDrawing> table;   ///< null: nothing has been drawn
    std::vector<DrawnBall> balls;                ///< in the order of drawing, the farthest first
    std::vector<DrawnShape> shapes{};            ///< lines and boxes
    std::shared_ptr<const EdgesInView> edges{};  ///< null if the table was drawn with many samples
};

/// For each square of pixels, whether it shows nothing but cloth.
class ClothMap {
  public:
    ClothMap() = default;
    /// @param rgba  rows of the picture of the table; alpha 255 marks a pixel that shows only cloth
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

/// The visible balls of a list, with their boxes.
std::vector<DrawnBall> visible_balls(const DrawList& list, const ClothMap& cloth);

/// Boxes outside which the two pictures are equal; the whole image if nothing better is known.
std::vector<PixelBox> differing_boxes(const DrawnPicture& before, const DrawnPicture& after, FrameSize size);

/// The things to redraw in some boxes: a flag for each ball, and for each line or box.
struct Inside {
    std::vector<bool> balls, shapes;
};
/// Adds the box of each ball and shape that overlaps one of the boxes, and so on until none is partly inside.
/// If that comes to half of the image, everything is redrawn.
Inside inside(const DrawnPicture& picture, std::vector<PixelBox>& boxes, FrameSize size);

}  // namespace carom::render
