#include "draw/static_layer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "draw/shaders.h"
#include "gl/objects.h"

namespace carom::render {

namespace {

constexpr float kRoom = 0.004F;  // radiance of the dark room around the table

// Sample position of pass i in the pixel, in (-1/2, 1/2)^2: the R2 sequence, evenly spread for every count.
double r2(int i, double step) {
    const double x = 0.5 + step * i;
    return x - static_cast<double>(static_cast<long>(x)) - 0.5;
}

}  // namespace

// Memory that only drawing the table with many samples needs: two images of 16-bit floats, and the depths of the first
// four passes.
struct StaticLayer::Scratch {
    static constexpr std::size_t kDepths = 4;  // [-] one for each channel of the occluder texture
    const gl::Api& api;
    GLuint pass, sum, sum_framebuffer;
    std::array<GLuint, kDepths> depth{}, pass_framebuffer{};

    Scratch(const gl::Api& a, int width, int height) : api(a) {
        pass = gl::make_texture(api, width, height, GL_RGBA16F, GL_RGBA, GL_FLOAT, nullptr);
        sum = gl::make_texture(api, width, height, GL_RGBA16F, GL_RGBA, GL_FLOAT, nullptr);
        sum_framebuffer = gl::make_framebuffer(api, sum, 0);
        for (std::size_t i = 0; i < kDepths; ++i) {
            depth[i] = gl::make_texture(api, width, height, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT,
                                        GL_FLOAT, nullptr);
            pass_framebuffer[i] = gl::make_framebuffer(api, pass, depth[i]);
        }
    }
    ~Scratch() {
        api.BindFramebuffer(GL_FRAMEBUFFER, 0);
        api.DeleteFramebuffers(1, &sum_framebuffer);
        api.DeleteFramebuffers(kDepths, pass_framebuffer.data());
        api.DeleteTextures(kDepths, depth.data());
        api.DeleteTextures(1, &pass);
        api.DeleteTextures(1, &sum);
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    // Passes after the fourth share the depth buffer of the fourth, whose depths have been copied by then.
    std::size_t slot(int number) const { return std::min(static_cast<std::size_t>(number), kDepths - 1); }
};

StaticLayer::StaticLayer(const gl::Api& api) : api_(api) {
    add_program_ = shaders::make_program(api, shaders::kFullscreenVertex, shaders::kAddFragment, {"u_pass"});
    add_weight_ = api.GetUniformLocation(add_program_, "u_weight");
    depth_program_ = shaders::make_program(api, shaders::kFullscreenVertex, shaders::kDepthFragment,
                                           {"u_depth0", "u_depth1", "u_depth2", "u_depth3"});
    resolve_program_ =
        shaders::make_program(api, shaders::kFullscreenVertex, shaders::kResolveFragment, {"u_pass"});
    api.GenVertexArrays(1, &empty_array_);
    api.GenVertexArrays(1, &vertex_array_);
    api.GenBuffers(1, &buffer_);
}

StaticLayer::~StaticLayer() = default;

StaticLayer::Programs StaticLayer::make_programs(const char* output) const {
    using namespace shaders;
    Programs programs;
    const auto make = [&](Part part, const std::string& kind) {
        Program& program = programs[static_cast<std::size_t>(part)];
        program.id = make_program(api_, kTableVertex, kTableFragment, {}, kind + output);
        program.jitter = api_.GetUniformLocation(program.id, "u_jitter");
    };
    make(Part::kCloth, kClothOnly);
    make(Part::kWood, kWoodOnly);
    make(Part::kSmall, kTheRest);
    make(Part::kFloor, kFloorOnly);
    make(Part::kCutCloth, std::string(kClothOnly) + kHoles);
    make(Part::kCutWood, std::string(kWoodOnly) + kHoles);
    make(Part::kChalk, kChalkOnly);
    make(Part::kShade, kShadeOnly);
    make(Part::kCutShade, std::string(kShadeOnly) + kHoles);
    return programs;
}

void StaticLayer::upload(const TableMesh& table, const TableEdges* edges, const Programs& programs) {
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
    for (const Program& program : programs) set_table_uniforms(table, program.id);
    uploaded_ = &table;
}

void StaticLayer::resize(int width, int height) {
    if (width == width_ && height == height_) return;
    if (color_ != 0) {
        const GLuint textures[] = {color_, occluders_, depth_},
                     framebuffers[] = {color_framebuffer_, occluders_framebuffer_, once_framebuffer_};
        api_.DeleteFramebuffers(3, framebuffers);
        api_.DeleteTextures(3, textures);
    }
    occluders_ = depth_ = occluders_framebuffer_ = once_framebuffer_ = 0;
    color_ = gl::make_texture(api_, width, height, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    color_framebuffer_ = gl::make_framebuffer(api_, color_, 0);
    width_ = width;
    height_ = height;
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
    const Vec2 low = table.inner_low - table.origin, high = table.inner_high - table.origin;
    api_.Uniform4f(at("u_inner"), static_cast<float>(low.x()), static_cast<float>(low.y()),
                   static_cast<float>(high.x()), static_cast<float>(high.y()));
}

void StaticLayer::draw_parts(const Programs& programs, double jitter_x, double jitter_y) {
    api_.DepthMask(GL_TRUE);
    api_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    api_.Enable(GL_DEPTH_TEST);
    api_.DepthFunc(GL_LEQUAL);
    api_.Disable(GL_BLEND);
    api_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    api_.BindVertexArray(vertex_array_);
    std::size_t first = 0;
    for (std::size_t i = 0; i < kPartCount; ++i) {
        const auto part = static_cast<Part>(i);
        if (part == Part::kChalk) api_.DepthMask(GL_FALSE);
        // The shading is blended over the cloth and keeps its alpha.
        if (part == Part::kShade) api_.Enable(GL_BLEND);
        api_.UseProgram(programs[i].id);
        api_.Uniform2f(programs[i].jitter, static_cast<float>(2.0 * jitter_x / width_),
                       static_cast<float>(2.0 * jitter_y / height_));
        api_.DrawArrays(GL_TRIANGLES, static_cast<GLint>(first),
                        static_cast<GLsizei>(parts_.ends[i] - first));
        first = parts_.ends[i];
    }
}

void StaticLayer::draw_pass(const Scratch& scratch, int pass, int samples) {
    // The steps of the R2 sequence are 1 / p and 1 / p^2, with the plastic number p.
    const double jx = samples == 1 ? 0.0 : r2(pass, 0.75487766624669276),
                 jy = samples == 1 ? 0.0 : r2(pass, 0.56984029099805327);
    api_.BindFramebuffer(GL_FRAMEBUFFER, scratch.pass_framebuffer[scratch.slot(pass)]);
    api_.ClearColor(kRoom, kRoom, kRoom, 0.0F);
    draw_parts(sum_programs_, jx, jy);
}

void StaticLayer::draw_once(const TableMesh& table, FrameSize size) {
    if (screen_programs_[0].id == 0) screen_programs_ = make_programs(shaders::kScreen);
    if (uploaded_ != &table || !edges_) {
        edges_ = std::make_shared<const TableEdges>(find_edges(table));
        upload(table, edges_.get(), screen_programs_);
    }
    resize(size.width, size.height);
    if (depth_ == 0) {
        depth_ = gl::make_texture(api_, width_, height_, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT,
                                  nullptr);
        once_framebuffer_ = gl::make_framebuffer(api_, color_, depth_);
    }
    api_.Viewport(0, 0, width_, height_);
    api_.BindFramebuffer(GL_FRAMEBUFFER, once_framebuffer_);
    const float room = std::sqrt(kRoom);  // to_screen() of the background
    api_.ClearColor(room, room, room, 0.0F);
    draw_parts(screen_programs_, 0.0, 0.0);
}

void StaticLayer::add_pass(const Scratch& scratch, int pass) {
    api_.Disable(GL_DEPTH_TEST);
    api_.BindVertexArray(empty_array_);
    api_.BindFramebuffer(GL_FRAMEBUFFER, scratch.sum_framebuffer);
    // The first pass replaces the sum of the previous drawing.
    pass == 0 ? api_.Disable(GL_BLEND) : api_.Enable(GL_BLEND);
    api_.BlendFuncSeparate(GL_ONE, GL_ONE, GL_ONE, GL_ONE);
    api_.UseProgram(add_program_);
    gl::bind_texture(api_, 0, scratch.pass);
    api_.DrawArrays(GL_TRIANGLES, 0, 3);
    api_.Disable(GL_BLEND);
}

// Writes one channel for each of the first four passes; with fewer passes the last one fills the rest.
void StaticLayer::keep_depths(const Scratch& scratch, int samples) {
    api_.BindFramebuffer(GL_FRAMEBUFFER, occluders_framebuffer_);
    api_.UseProgram(depth_program_);
    for (int i = 0; i < static_cast<int>(Scratch::kDepths); ++i)
        gl::bind_texture(api_, i, scratch.depth[scratch.slot(std::min(i, samples - 1))]);
    api_.DrawArrays(GL_TRIANGLES, 0, 3);
}

void StaticLayer::draw(const TableMesh& table, FrameSize size, int samples,
                       const std::function<void(int, int)>& on_pass) {
    samples = std::max(samples, 1);
    if (sum_programs_[0].id == 0) sum_programs_ = make_programs("");
    if (uploaded_ != &table || edges_) upload(table, nullptr, sum_programs_);
    edges_ = nullptr;
    resize(size.width, size.height);
    if (occluders_ == 0) {
        occluders_ = gl::make_texture(api_, width_, height_, GL_RGBA32F, GL_RGBA, GL_FLOAT, nullptr);
        occluders_framebuffer_ = gl::make_framebuffer(api_, occluders_, 0);
    }
    const Scratch scratch(api_, width_, height_);
    api_.Viewport(0, 0, width_, height_);
    api_.UseProgram(add_program_);
    api_.Uniform1f(add_weight_, 1.0F / static_cast<float>(samples));
    for (int pass = 0; pass < samples; ++pass) {
        draw_pass(scratch, pass, samples);
        add_pass(scratch, pass);
        if (pass == std::min(samples, static_cast<int>(Scratch::kDepths)) - 1) keep_depths(scratch, samples);
        if (!on_pass) continue;
        api_.Finish();
        on_pass(pass + 1, samples);
    }
    api_.BindFramebuffer(GL_FRAMEBUFFER, color_framebuffer_);
    api_.UseProgram(resolve_program_);
    gl::bind_texture(api_, 0, scratch.sum);
    api_.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace carom::render
