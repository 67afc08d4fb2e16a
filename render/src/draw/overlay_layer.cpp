#include "draw/overlay_layer.h"

#include <cstddef>
#include <vector>

#include "draw/shaders.h"
#include "gl/objects.h"

namespace carom::render {

namespace {

struct LineInstance {
    float from[3], to[3], color[4], width;
};

struct BoxInstance {
    float box[4], color[4], glyph;
};

float f(double value) {
    return static_cast<float>(value);
}

}  // namespace

OverlayLayer::OverlayLayer(const gl::Api& api, GLuint glyphs) : api_(api), glyphs_(glyphs) {
    for (std::size_t i = 0; i < line_programs_.size(); ++i) {
        line_programs_[i] =
            shaders::make_program(api, shaders::kLineVertex, shaders::kLineFragment, {"u_occluders"},
                                  i == 0 ? shaders::kManySamples : shaders::kOneSample);
    }
    box_program_ = shaders::make_program(api, shaders::kBoxVertex, shaders::kBoxFragment, {"u_glyphs"});
    const auto make = [&](GLuint& array, GLuint& buffer) {
        api.GenVertexArrays(1, &array);
        api.GenBuffers(1, &buffer);
        api.BindVertexArray(array);
        api.BindBuffer(GL_ARRAY_BUFFER, buffer);
    };
    const auto attribute = [&](GLuint index, GLint count, std::size_t stride, std::size_t offset) {
        api.EnableVertexAttribArray(index);
        api.VertexAttribPointer(index, count, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                                gl::buffer_offset(offset));
        api.VertexAttribDivisor(index, 1);
    };
    make(line_array_, line_buffer_);
    attribute(0, 3, sizeof(LineInstance), offsetof(LineInstance, from));
    attribute(1, 3, sizeof(LineInstance), offsetof(LineInstance, to));
    attribute(2, 4, sizeof(LineInstance), offsetof(LineInstance, color));
    attribute(3, 1, sizeof(LineInstance), offsetof(LineInstance, width));
    make(box_array_, box_buffer_);
    attribute(0, 4, sizeof(BoxInstance), offsetof(BoxInstance, box));
    attribute(1, 4, sizeof(BoxInstance), offsetof(BoxInstance, color));
    attribute(2, 1, sizeof(BoxInstance), offsetof(BoxInstance, glyph));
}

void OverlayLayer::draw_lines(const DrawList& list, Occluders occluders, LineLayer layer) {
    const Vec3 origin(list.table->origin.x(), list.table->origin.y(), 0.0);
    std::vector<LineInstance> instances;
    for (const DrawLine& line : list.lines) {
        if (line.layer != layer) continue;
        const Vec3 a = line.a - origin, b = line.b - origin;
        const Rgba& c = line.color;
        instances.push_back({{f(a.x()), f(a.y()), f(a.z())},
                             {f(b.x()), f(b.y()), f(b.z())},
                             {c[0], c[1], c[2], c[3]},
                             line.width});
    }
    if (instances.empty()) return;
    api_.BindVertexArray(line_array_);
    api_.BindBuffer(GL_ARRAY_BUFFER, line_buffer_);
    api_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances.size() * sizeof(LineInstance)),
                    instances.data(), GL_STREAM_DRAW);
    api_.UseProgram(line_programs_[occluders.one_sample ? 1 : 0]);
    gl::bind_texture(api_, 0, occluders.texture);
    api_.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(instances.size()));
}

void OverlayLayer::draw_boxes(const DrawList& list) {
    if (list.boxes.empty()) return;
    std::vector<BoxInstance> instances;
    for (const DrawBox& box : list.boxes) {
        const Rgba& c = box.color;
        instances.push_back({{f(box.low.x()), f(box.low.y()), f(box.high.x()), f(box.high.y())},
                             {c[0], c[1], c[2], c[3]},
                             static_cast<float>(box.glyph)});
    }
    api_.BindVertexArray(box_array_);
    api_.BindBuffer(GL_ARRAY_BUFFER, box_buffer_);
    api_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances.size() * sizeof(BoxInstance)),
                    instances.data(), GL_STREAM_DRAW);
    api_.UseProgram(box_program_);
    gl::bind_texture(api_, 0, glyphs_);
    api_.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(instances.size()));
}

}  // namespace carom::render
