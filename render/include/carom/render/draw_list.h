// What to draw, with no OpenGL in it: Record and time in, DrawList out.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "carom/render/camera.h"
#include "carom/render/table_mesh.h"

namespace carom::render {

enum class BallPattern : std::uint8_t {
    kSolid,   ///< one colour, numbered
    kStripe,  ///< white with a coloured band, numbered
    kDots,    ///< one colour with six small dots, so that a turn shows
    kHalves,  ///< two shades of one colour: for balls that are not of a known game
};

struct BallStyle {
    std::array<float, 3> color{1.0F, 1.0F, 1.0F};  ///< sRGB, 0..1
    BallPattern pattern = BallPattern::kSolid;
    int number = 0;  ///< 1..99, or 0 for none
};

/// How a ball looks, by its id and the table it is on ("3" is a numbered ball, but a red one on a snooker
/// table).
BallStyle ball_style(const std::string& id, const std::string& table_preset, int index);

struct DrawBall {
    Vec3 center{0.0, 0.0, 0.0};
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< body to table
    double radius = 0.0;
    BallStyle style;
    bool in_pocket = false;
};

struct DrawList {
    std::shared_ptr<const TableMesh> table;
    Camera camera;
    std::vector<DrawBall> balls;
    int table_samples =
        16;  ///< per pixel of the table; it is drawn anew only when the camera or the table changes
};

/// Turns a record into draw lists: what does not change with time is made once.
class Stage {
  public:
    /// `record` must outlive the stage. @throws RenderError for an unknown camera
    Stage(const Record& record, const std::string& camera, FrameSize size);

    DrawList at(double t) const;
    const std::shared_ptr<const TableMesh>& table() const { return table_; }

  private:
    const Record& record_;
    std::shared_ptr<const TableMesh> table_;
    std::vector<BallStyle> styles_;
    std::string camera_;
    FrameSize size_;
};

}  // namespace carom::render
