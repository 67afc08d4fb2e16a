// The list of things to draw, independent of OpenGL: a Stage turns a Record and a time into a DrawList.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/record.h"
#include "carom/render/camera.h"
#include "carom/render/camera_path.h"
#include "carom/render/overlay.h"
#include "carom/render/table_mesh.h"

namespace carom::render {

enum class BallPattern : std::uint8_t {
    kSolid,   ///< one colour, numbered
    kStripe,  ///< white with a coloured band, numbered
    kDots,    ///< one colour with six small dots, so that a rotation is visible
    kHalves,  ///< two shades of one colour: for balls that belong to no known game
};

struct BallStyle {
    std::array<float, 3> color{1.0F, 1.0F, 1.0F};  ///< sRGB, 0..1
    BallPattern pattern = BallPattern::kSolid;
    int number = 0;  ///< 1..99, or 0 for none
};

/// The style of a ball by its id and its table ("3" is a numbered ball, but a red ball on a snooker table).
BallStyle ball_style(const std::string& id, const std::string& table_preset, int index);

struct DrawBall {
    Vec3 center{0.0, 0.0, 0.0};
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< body to table
    double radius = 0.0;
    BallStyle style;
    bool in_pocket = false;
};

using Rgba = std::array<float, 4>;  ///< sRGB and opacity, 0..1

enum class LineLayer : std::uint8_t { kUnderBalls, kOverBalls };

/// A straight line in the table frame [m] with a width in
/// pixels and round ends. Nearer parts of the table hide it.
struct DrawLine {
    Vec3 a{0.0, 0.0, 0.0}, b{0.0, 0.0, 0.0};
    float width = 2.0F;
    Rgba color{1.0F, 1.0F, 1.0F, 1.0F};
    LineLayer layer = LineLayer::kUnderBalls;

    bool operator==(const DrawLine&) const = default;
};

/// A rectangle of the image [pixels]: filled, or the cell of one character (`glyph`).
struct DrawBox {
    Vec2 low{0.0, 0.0}, high{0.0, 0.0};
    Rgba color{1.0F, 1.0F, 1.0F, 1.0F};
    int glyph = -1;

    bool operator==(const DrawBox&) const = default;
};

/// A cue: a cone from the middle of its tip to the end of its butt [m].
struct DrawCue {
    Vec3 tip{0.0, 0.0, 0.0}, butt{0.0, 0.0, 0.0};
    float opacity = 1.0F;

    bool operator==(const DrawCue&) const = default;
};

struct DrawList {
    std::shared_ptr<const TableMesh> table;
    Camera camera;
    std::vector<DrawBall> balls;
    std::optional<DrawCue> cue;
    std::vector<DrawLine> lines;
    std::vector<DrawBox> boxes;
    /// Samples per pixel of the table, which is redrawn only when the camera or the table changes
    int table_samples = 16;
    /// For a camera that differs from frame to frame: the table is drawn with one sample per pixel, and then
    /// its edges are smoothed by the share of each pixel that they cut off. The mesh should be made with
    /// Edges::kSharp.
    bool camera_moves = false;
    /// Cloth, wood and walls are drawn with less detail, because every frame of a moving camera draws them.
    bool less_detail = false;
};

/// Appends a line of text with its upper left corner at `at`. `height`: height of a capital letter [pixels].
/// Characters without a glyph are left blank.
void add_text(DrawList& list, const Vec2& at, double height, std::string_view text, const Rgba& color);

/// Width of the same text [pixels].
double text_width(double height, std::string_view text);

struct StageOptions {
    std::string camera = "top";
    FreeCamera view;
    Overlay overlay;
    FrameSize size;
    /// Samples per pixel of the table up to 1920x1080. A larger picture has as many samples in all, but at
    /// least four per pixel, if this allows them
    int table_samples = 16;
};

/// Computing time of one frame and the time available for it; the margin bar shows both.
struct FrameBudget {
    double cost_ms = 0.0, budget_ms = 0.0;
};

/// Turns a record into draw lists. Everything that does not change with time is computed once.
class Stage {
  public:
    /// `record` must outlive the stage. @throws RenderError for an unknown camera
    Stage(const Record& record, const StageOptions& options);

    DrawList at(double t, std::optional<FrameBudget> cost = std::nullopt) const;
    const std::shared_ptr<const TableMesh>& table() const { return table_; }

  private:
    const Record& record_;
    StageOptions options_;
    std::shared_ptr<const TableMesh> table_;
    CameraPath camera_;
    std::vector<BallStyle> styles_;
};

}  // namespace carom::render
