#include "carom/render/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace carom::render {

Vec3 Camera::forward() const {
    return (target - eye).normalized();
}

Vec3 Camera::right() const {
    return forward().cross(up).normalized();
}

Vec3 Camera::image_up() const {
    return right().cross(forward());
}

double Camera::tan_half_y() const {
    return std::tan(fov_y_deg * std::numbers::pi / 360.0);
}

double Camera::tan_half_x() const {
    return tan_half_y() * size.width / size.height;
}

double Camera::depth(const Vec3& point) const {
    return (point - eye).dot(forward());
}

std::optional<Vec2> Camera::project(const Vec3& point) const {
    const Vec3 offset = point - eye;
    const double z = offset.dot(forward());
    if (!(z > 0.0)) return std::nullopt;
    const double x = offset.dot(right()) / (z * tan_half_x());
    const double y = offset.dot(image_up()) / (z * tan_half_y());
    return Vec2((1.0 + x) * 0.5 * size.width, (1.0 - y) * 0.5 * size.height);
}

double Camera::scale(const Vec3& point) const {
    return 0.5 * size.height / (tan_half_y() * depth(point));
}

bool Camera::operator==(const Camera& other) const {
    return eye == other.eye && target == other.target && up == other.up && fov_y_deg == other.fov_y_deg &&
           size == other.size;
}

Camera top_camera(const Bounds& bounds, FrameSize size) {
    // [deg] Narrow, so that balls at the rails are hardly seen from the side, but wide enough to keep the
    // depth.
    constexpr double kFov = 16.0;
    const Vec2 extent = (bounds.high - bounds.low).cwiseMax(1e-3);
    const Vec2 centre = 0.5 * (bounds.low + bounds.high);
    const double upright = std::min(size.width / extent.x(), size.height / extent.y());
    const double lying = std::min(size.width / extent.y(), size.height / extent.x());

    Camera camera;
    camera.size = size;
    camera.fov_y_deg = kFov;
    // y x (-x) = z: if +y points to the right of the image, -x points up, seen from above.
    camera.up = lying > upright ? Vec3(-1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    const double pixels_per_metre = std::max(upright, lying);
    const double distance = 0.5 * size.height / (pixels_per_metre * camera.tan_half_y());
    camera.target = Vec3(centre.x(), centre.y(), 0.0);
    camera.eye = Vec3(centre.x(), centre.y(), bounds.top + distance);
    return camera;
}

}  // namespace carom::render
