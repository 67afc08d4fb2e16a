// Named cameras: the position of the eye at every time of a shot.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "carom/render/camera.h"
#include "carom/render/table_mesh.h"

namespace carom::render {

/// A view given in numbers, and the options of named cameras.
struct FreeCamera {
    std::optional<Vec3> eye, target;  ///< [m]; set both, or neither for a named camera
    double fov_deg = 45.0;            ///< vertical field of view of the free camera [deg]
    std::string ball;                 ///< id of the ball for "follow"; default: the ball that moves first
};

/// top: from above; the table fills the image. rail: from behind the head rail; the moving balls fill the
/// image. player: from behind the ball that moves first, looking along its path at the moving balls. follow:
/// behind a ball, moving smoothly with it.
class CameraPath {
  public:
    /// `record` must outlive the path. @throws RenderError for an unknown camera or ball, listing the known
    /// ones
    CameraPath(const Record& record, const TableMesh& table, const std::string& name, const FreeCamera& free,
               FrameSize size);

    Camera at(double t) const;
    bool moves() const { return follow_ball_ >= 0; }

    /// Whether a path with this name and these numbers will move.
    static bool moves(const std::string& name, const FreeCamera& free) {
        return name == "follow" && !free.eye;
    }

  private:
    const Record& record_;
    Camera fixed_;
    int follow_ball_ = -1;
    Vec3 follow_offset_{0.0, 0.0, 1.0};
};

/// A camera that looks along `direction`, at the shortest distance that still shows all of the points.
Camera fitting_camera(const std::vector<Vec3>& points, const Vec3& direction, double fov_y_deg,
                      FrameSize size);

/// Positions along the path of every ball, or of every one that moves: the ends of its segments and points
/// between them.
std::vector<Vec2> visited_places(const Record& record, bool moving = false);

/// Index of the ball that moves first: the struck ball, else the first ball with a velocity; 0 if none moves.
int first_ball(const Record& record);

}  // namespace carom::render
