#include "draw/view.h"

#include <Eigen/Core>
#include <algorithm>

namespace carom::render {

namespace {

std::array<float, 3> to_float(const Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

// Near and far planes around everything that can be seen, as tight as the eye's distance from the table allows.
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
    row(1, -up / tan_y, up.dot(eye) / tan_y);  // negated: OpenGL's lowest row is the image's first
    const double a = (far + near) / (far - near), b = -2.0 * far * near / (far - near);
    row(2, a * forward, -a * forward.dot(eye) + b);
    row(3, forward, -forward.dot(eye));

    View view;
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r)
            view.view_projection[4 * static_cast<std::size_t>(c) + static_cast<std::size_t>(r)] =
                static_cast<float>(m(r, c));
    }
    view.eye = to_float(eye);
    view.forward = to_float(forward);
    view.right_scaled = to_float(right * tan_x);
    view.up_scaled = to_float(up * tan_y);
    view.lamp = to_float(table.lamp.center - origin);
    view.lamp_half = {static_cast<float>(table.lamp.half.x()), static_cast<float>(table.lamp.half.y())};
    view.lamp_endless = table.lamp.endless ? 1.0F : 0.0F;
    view.size = {static_cast<float>(camera.size.width), static_cast<float>(camera.size.height)};
    view.planes = {static_cast<float>(near), static_cast<float>(far)};
    return view;
}

void View::set(const gl::Api& api, GLuint program) const {
    const auto at = [&](const char* uniform) { return api.GetUniformLocation(program, uniform); };
    const auto set3 = [&](const char* uniform, const std::array<float, 3>& v) {
        api.Uniform3f(at(uniform), v[0], v[1], v[2]);
    };
    api.UseProgram(program);
    api.UniformMatrix4fv(at("u_view_projection"), 1, GL_FALSE, view_projection.data());
    set3("u_eye", eye);
    set3("u_forward", forward);
    set3("u_right_scaled", right_scaled);
    set3("u_up_scaled", up_scaled);
    set3("u_lamp", lamp);
    api.Uniform2f(at("u_size"), size[0], size[1]);
    api.Uniform2f(at("u_lamp_half"), lamp_half[0], lamp_half[1]);
    api.Uniform1f(at("u_lamp_endless"), lamp_endless);
}

}  // namespace carom::render
