// The data that every shader reads: camera and lamp, relative to the origin of the table mesh.
#pragma once

#include "carom/render/draw_list.h"

namespace carom::render {

/// The uniform block View of shaders/common.glsl: the same members in the layout std140, which aligns vectors
/// of three to 16 bytes. It is written to a buffer once per frame; programs read it at binding point 0.
struct View {
    alignas(16) float view_projection[16] = {};  ///< column-major; row 0 of the image is the top
    alignas(16) float eye[3] = {};
    float lamp_endless = 0.0F;
    alignas(16) float forward[3] = {};
    alignas(16) float right_scaled[3] = {};
    alignas(16) float up_scaled[3] = {};
    alignas(16) float lamp[3] = {};
    alignas(8) float size[2] = {};
    float lamp_half[2] = {};
    float planes[2] = {};  ///< near and far
    alignas(16) float inner[4] = {};
    alignas(16) float cloth[3] = {};
};

View make_view(const Camera& camera, const TableMesh& table);

}  // namespace carom::render
