#include "draw/static_layer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "draw/mean_picture.h"
#include "draw/shader_numbers.h"
#include "draw/shaders.h"
#include "draw/table_edges.h"
#include "gl/objects.h"

namespace carom::render {

namespace {

constexpr float kRoom = 0.004F;  // radiance of the dark room around the table

// Sample position of pass i in the pixel, in (-1/2, 1/2)^2: the R2 sequence, evenly spread for every number
// of passes.
double r2(int i, double step) {
    const double x = 0.5 + step * i;
    return x - static_cast<double>(static_cast<long>(x)) - 0.5;
}

}  // namespace

StaticLayer::StaticLayer(const gl::Api& api) : api_(api) {
    api_.GenVertexArrays(1, &vertex_array_);
    api_.GenBuffers(1, &buffer_);
}

StaticLayer::~StaticLayer() = default;

StaticLayer::Programs& StaticLayer::programs_for(bool less_detail) {
    using namespace shaders;
    Programs& programs = programs_[less_detail ? 1 : 0];
    if (programs[0].fragment != 0) return programs;
    if (vertex_program_ == 0) vertex_program_ = make_stage(api_, GL_VERTEX_SHADER, kTableVertex);
    jitter_ = api_.GetUniformLocation(vertex_program_, "u_jitter");
    const auto make = [&](Part part, const std::string& kind) {
        Program& program = programs[static_cast<std::size_t>(part)];
        program.fragment =
            make_stage(api_, GL_FRAGMENT_SHADER, kTableFragment, less_detail ? kind + kLessDetail : kind);
        program.pipeline = gl::make_pipeline(api_, vertex_program_, program.fragment);
    };
    make(Part::kCloth, kClothOnly);
    make(Part::kWood, kWoodOnly);
    make(Part::kSmall, kTheRest);
    make(Part::kFloor, kFloorOnly);
    make(Part::kWall, kWallOnly);
    make(Part::kCutCloth, std::string(kClothOnly) + kHoles);
    make(Part::kCutWood, std::string(kWoodOnly) + kHoles);
    make(Part::kChalk, kChalkOnly);
    make(Part::kShade, kShadeOnly);
    make(Part::kCutShade, std::string(kShadeOnly) + kHoles);
    return programs;
}

void StaticLayer::upload(const TableMesh& table, const TableEdges* edges, bool less_detail) {
    const Programs& programs = programs_for(less_detail);
    parts_ = sort_parts(table, edges == nullptr ? std::vector<std::uint8_t>{} : edges->faces);
    api_.BindVertexArray(vertex_array_);
    api_.BindBuffer(GL_ARRAY_BUFFER, buffer_);
    api_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(parts_.vertices.size() * sizeof(PartVertex)),
                    parts_.vertices.data(), GL_STATIC_DRAW);
    parts_.vertices = {};
    const auto attribute = [&](GLuint index, GLint count, std::size_t offset) {
        api_.EnableVertexAttribArray(index);
        api_.VertexAttribPointer(index, count, GL_FLOAT, GL_FALSE, sizeof(PartVertex),
                                 gl::buffer_offset(offset));
    };
    attribute(0, 3, offsetof(MeshVertex, x));
    attribute(1, 3, offsetof(MeshVertex, nx));
    attribute(2, 4, offsetof(MeshVertex, u));  // u, v, material, and the face behind the vertex
    static_assert(offsetof(PartVertex, face) == offsetof(MeshVertex, material) + sizeof(float));
    for (const Program& program : programs) set_table_uniforms(table, program.fragment);
    uploaded_ = &table;
    less_detail_ = less_detail;
}

void StaticLayer::resize(FrameSize size) {
    if (size == size_) return;
    if (framebuffer_ != 0) {
        const GLuint textures[] = {color_, depth_};
        api_.DeleteFramebuffers(1, &framebuffer_);
        api_.DeleteTextures(2, textures);
        framebuffer_ = 0;
    }
    color_ = gl::make_texture(api_, size.width, size.height, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    depth_ = gl::make_texture(api_, size.width, size.height, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT,
                              GL_FLOAT, nullptr);
    framebuffer_ = gl::make_framebuffer(api_, color_, depth_);
    size_ = size;
}

void StaticLayer::set_table_uniforms(const TableMesh& table, GLuint program) const {
    api_.UseProgram(program);
    const auto at = [&](const char* uniform) { return api_.GetUniformLocation(program, uniform); };
    std::vector<float> holes;
    for (const Hole& hole : table.holes) {
        if (holes.size() == std::size_t{4} * shaders::kMaxHoles) break;
        const Vec2 center = hole.center - table.origin;
        holes.insert(holes.end(), {static_cast<float>(center.x()), static_cast<float>(center.y()),
                                   static_cast<float>(hole.radius), 0.0F});
    }
    const auto count = static_cast<GLsizei>(holes.size() / 4);
    if (count > 0) api_.Uniform4fv(at("u_holes"), count, holes.data());
    api_.Uniform1i(at("u_hole_count"), count);
}

// @param depths initial contents of the depth buffer; null: the far plane
void StaticLayer::draw_parts(double jitter_x, double jitter_y, const float* depths) {
    api_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    api_.Viewport(0, 0, size_.width, size_.height);
    const float room = std::sqrt(kRoom);  // to_screen() of the background
    api_.ClearColor(room, room, room, 0.0F);
    api_.DepthMask(GL_TRUE);
    api_.Clear(depths == nullptr ? GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT : GL_COLOR_BUFFER_BIT);
    if (depths != nullptr) {
        api_.BindTexture(GL_TEXTURE_2D, depth_);
        api_.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size_.width, size_.height, GL_DEPTH_COMPONENT, GL_FLOAT,
                           depths);
    }
    api_.Enable(GL_DEPTH_TEST);
    api_.DepthFunc(GL_LEQUAL);
    api_.Disable(GL_BLEND);
    api_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    api_.BindVertexArray(vertex_array_);
    api_.UseProgram(vertex_program_);
    api_.Uniform2f(jitter_, static_cast<float>(2.0 * jitter_x / size_.width),
                   static_cast<float>(2.0 * jitter_y / size_.height));
    api_.UseProgram(0);  // so that the pipelines take effect
    std::size_t first = 0;
    for (std::size_t i = 0; i < kPartCount; ++i) {
        const auto part = static_cast<Part>(i);
        if (part == Part::kChalk) api_.DepthMask(GL_FALSE);
        // The shading is blended over the cloth and keeps its alpha.
        if (part == Part::kShade) api_.Enable(GL_BLEND);
        // The near walls of the room do not hide the table. Turns are reversed, because rows are.
        api_.FrontFace(GL_CW);
        (part == Part::kFloor || part == Part::kWall ? api_.Enable : api_.Disable)(GL_CULL_FACE);
        api_.BindProgramPipeline(programs_[less_detail_ ? 1 : 0][i].pipeline);
        api_.DrawArrays(GL_TRIANGLES, static_cast<GLint>(first),
                        static_cast<GLsizei>(parts_.ends[i] - first));
        first = parts_.ends[i];
    }
}

void StaticLayer::read_color(std::vector<std::uint8_t>& rgba) {
    rgba.resize(std::size_t{4} * static_cast<std::size_t>(size_.width) *
                static_cast<std::size_t>(size_.height));
    api_.PixelStorei(GL_PACK_ALIGNMENT, 4);
    api_.ReadPixels(0, 0, size_.width, size_.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
}

void StaticLayer::read_depths(std::vector<float>& depths) {
    depths.resize(static_cast<std::size_t>(size_.width) * static_cast<std::size_t>(size_.height));
    api_.ReadPixels(0, 0, size_.width, size_.height, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
}

void StaticLayer::draw_once(const TableMesh& table, FrameSize size, bool less_detail) {
    if (uploaded_ != &table || !edges_ || less_detail_ != less_detail) {
        edges_ = std::make_shared<const TableEdges>(find_edges(table));
        upload(table, edges_.get(), less_detail);
    }
    resize(size);
    draw_parts(0.0, 0.0, nullptr);
    picture_.size = size;
    read_color(picture_.rgba);
    read_depths(picture_.depths[0]);
    picture_.depth_count = 1;
}

void StaticLayer::draw(const TableMesh& table, const View& view, FrameSize size, int samples,
                       bool less_detail, const std::function<void(int, int)>& on_pass) {
    samples = std::max(samples, 1);
    if (uploaded_ != &table || edges_ || less_detail_ != less_detail) upload(table, nullptr, less_detail);
    edges_ = nullptr;
    resize(size);
    picture_.size = size;
    picture_.depth_count = std::min(samples, static_cast<int>(picture_.depths.size()));
    draw_parts(0.0, 0.0, nullptr);
    read_color(picture_.rgba);
    read_depths(picture_.depths[0]);
    const std::vector<PixelBox> busy = busy_tiles(picture_.rgba, size, table, view);
    // Everywhere else the depth buffer starts with the near plane, so that nothing is drawn there.
    std::vector<float> begin(picture_.depths[0].size(), 0.0F), depths;
    const auto each_row = [&](const auto& at) {
        for (const PixelBox& box : busy) {
            for (int y = box.y0; y < box.y1; ++y) {
                const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width);
                at(row + static_cast<std::size_t>(box.x0), static_cast<std::size_t>(box.x1 - box.x0));
            }
        }
    };
    each_row([&](std::size_t first, std::size_t count) { std::fill_n(begin.data() + first, count, 1.0F); });
    MeanPicture mean(picture_.rgba, size.width, busy);
    std::vector<std::uint8_t> rgba;
    for (int pass = 1; pass < samples; ++pass) {
        // The steps of the R2 sequence are 1 / p and 1 / p^2, with the plastic number p.
        draw_parts(r2(pass, 0.75487766624669276), r2(pass, 0.56984029099805327), begin.data());
        read_color(rgba);
        mean.add(rgba);
        if (pass < picture_.depth_count) {
            std::vector<float>& kept = picture_.depths[static_cast<std::size_t>(pass)];
            kept = picture_.depths[0];
            read_depths(depths);
            each_row([&](std::size_t first, std::size_t count) {
                std::copy_n(depths.data() + first, count, kept.data() + first);
            });
        }
        if (on_pass) on_pass(pass + 1, samples);
    }
    mean.finish();
}

}  // namespace carom::render
