// Cameras by name: where the eye is at every time of a shot.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "carom/engine/record.h"
#include "carom/render/camera.h"
#include "carom/render/table_mesh.h"

namespace carom::render {

/// A view given in numbers, and what else a named camera can be told.
struct FreeCamera {
    std::optional<Vec3> eye, target;  ///< [m]; both, or neither for a named camera
    double fov_deg = 45.0;            ///< of the free camera, over the height of the image
    std::string ball;  ///< id of the ball that "follow" follows; default: the one that moves first
};

/// top: from above, the table filling the image. rail: from behind the head rail, the whole table. player:
/// over the ball that moves first, along its way. follow: behind a ball, moving smoothly with it.
class CameraPath {
  public:
    /// Both must outlive the path. @throws RenderError for an unknown camera or ball, naming those there are
    CameraPath(const Record& record, const TableMesh& table, const std::string& name, const FreeCamera& free,
               FrameSize size);

    Camera at(double t) const;
    bool moves() const { return follow_ball_ >= 0; }

  private:
    const Record& record_;
    Camera fixed_;
    int follow_ball_ = -1;
    Vec3 follow_offset_{0.0, 0.0, 1.0};
};

/// A camera looking along `direction` at the box, as near as shows all of it.
Camera fitting_camera(const Bounds& bounds, const Vec3& direction, double fov_y_deg, FrameSize size);

/// The ball that moves first: the one the cue strikes, or else the first with a velocity; 0 if none moves.
int first_ball(const Record& record);

}  // namespace carom::render
