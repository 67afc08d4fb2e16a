#include "draw/view.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>

namespace carom::render {

namespace {

template <class Vector, std::size_t kSize>
void put(const Vector& v, float (&out)[kSize]) {
    for (std::size_t i = 0; i < kSize; ++i) out[i] = static_cast<float>(v[i]);
}

// Near and far clip planes around everything visible, as
// tight as the distance of the eye from the table allows.
std::array<double, 2> clip_planes(const Camera& camera, const TableMesh& table) {
    const Vec3 low(table.bounds.low.x(), table.bounds.low.y(), -0.3);
    const Vec3 high(table.bounds.high.x(), table.bounds.high.y(), table.bounds.top + 0.1);
    const double nearest = (camera.eye - camera.eye.cwiseMax(low).cwiseMin(high)).norm();
    double farthest = 0.0;
    for (int i = 0; i < 8; ++i) {
        const Vec3 corner((i & 1) ? high.x() : low.x(), (i & 2) ? high.y() : low.y(),
                          (i & 4) ? high.z() : low.z());
        farthest = std::max(farthest, (corner - camera.eye).norm());
    }
    const double near = std::max(0.02, 0.4 * nearest);
    return {near, std::max(3.0 * farthest + 2.0, 2.0 * near)};
}

}  // namespace

View make_view(const Camera& camera, const TableMesh& table) {
    const Vec3 origin(table.origin.x(), table.origin.y(), 0.0);
    const Vec3 eye = camera.eye - origin, forward = camera.forward(), right = camera.right(),
               up = camera.image_up();
    const double tan_x = camera.tan_half_x(), tan_y = camera.tan_half_y();
    const auto [near, far] = clip_planes(camera, table);

    Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
    const auto row = [&](int i, const Vec3& axis, double shift) {
        m.block<1, 3>(i, 0) = axis.transpose();
        m(i, 3) = shift;
    };
    row(0, right / tan_x, -right.dot(eye) / tan_x);
    row(1, -up / tan_y, up.dot(eye) / tan_y);  // negated: OpenGL's lowest row is the first of the image
    const double a = (far + near) / (far - near), b = -2.0 * far * near / (far - near);
    row(2, a * forward, -a * forward.dot(eye) + b);
    row(3, forward, -forward.dot(eye));

    View view;
    put(m.reshaped(), view.view_projection);
    put(eye, view.eye);
    put(forward, view.forward);
    put(Vec3(right * tan_x), view.right_scaled);
    put(Vec3(up * tan_y), view.up_scaled);
    put(Vec3(table.lamp.center - origin), view.lamp);
    put(table.lamp.half, view.lamp_half);
    view.lamp_endless = table.lamp.endless ? 1.0F : 0.0F;
    put(Vec2(camera.size.width, camera.size.height), view.size);
    put(Vec2(near, far), view.planes);
    const Vec2 low = table.inner_low - table.origin, high = table.inner_high - table.origin;
    put(std::array{low.x(), low.y(), high.x(), high.y()}, view.inner);
    put(table.cloth, view.cloth);
    return view;
}

}  // namespace carom::render
