// A perspective camera. Lengths in m, table frame (z up).
// Pixels: x to the right, y down, pixel centres at +0.5.
#pragma once

#include <optional>

#include "carom/engine/frame_size.h"
#include "carom/engine/vec.h"

namespace carom::render {

struct Camera {
    Vec3 eye{0.0, 0.0, 1.0};
    Vec3 target{0.0, 0.0, 0.0};
    Vec3 up{0.0, 1.0, 0.0};   ///< any direction that is not parallel to the view direction
    double fov_y_deg = 40.0;  ///< full vertical field of view [deg]
    FrameSize size;

    Vec3 forward() const;   ///< unit vector
    Vec3 right() const;     ///< unit vector
    Vec3 image_up() const;  ///< unit vector
    double tan_half_y() const;
    double tan_half_x() const;

    /// Distance along the view direction [m].
    double depth(const Vec3& point) const;

    /// The pixel at which a point appears; it may lie outside the
    /// image. Empty if the point is not in front of the eye.
    std::optional<Vec2> project(const Vec3& point) const;

    /// Pixels per metre perpendicular to the view direction, at the depth of the point.
    double scale(const Vec3& point) const;

    bool operator==(const Camera& other) const;
};

/// An axis-aligned box that a camera must show.
struct Bounds {
    Vec2 low{0.0, 0.0}, high{0.0, 0.0};
    double top = 0.0;  ///< greatest height of the contents [m]
};

/// A camera far above the box, which fills the image; its
/// long side is parallel to the longer side of the image.
Camera top_camera(const Bounds& bounds, FrameSize size);

}  // namespace carom::render
