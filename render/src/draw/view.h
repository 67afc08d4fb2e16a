// The uniforms that every shader shares: camera and lamp, relative to the origin of the table mesh.
#pragma once

#include <array>

#include "carom/render/draw_list.h"
#include "gl/api.h"

namespace carom::render {

struct View {
    std::array<float, 16> view_projection{};  ///< column by column; image row 0 is the top
    std::array<float, 3> eye{}, forward{}, right_scaled{}, up_scaled{}, lamp{};
    std::array<float, 2> size{}, lamp_half{}, planes{};  ///< planes: near and far
    float lamp_endless = 0.0F;

    void set(const gl::Api& api, GLuint program) const;
};

View make_view(const Camera& camera, const TableMesh& table);

}  // namespace carom::render
