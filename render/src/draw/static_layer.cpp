#include "draw/static_layer.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "draw/shaders.h"
#include "gl/objects.h"

namespace carom::render {

namespace {

// Sample position of pass i in the pixel, in (-1/2, 1/2)^2: the R2 sequence, evenly spread for every count.
double r2(int i, double step) {
    const double x = 0.5 + step * i;
    return x - static_cast<double>(static_cast<long>(x)) - 0.5;
}

}  // namespace

// Memory that only drawing the table needs: two images of 16-bit floats, and the depths of the first four passes.
// It is kept between drawings only for a camera that moves.
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
    const auto table_program = [&](const char* kind) {
        return shaders::make_program(api, shaders::kTableVertex, shaders::kTableFragment, {}, kind);
    };
    groups_[kCloth].program = table_program(shaders::kClothOnly);
    groups_[kWood].program = table_program(shaders::kWoodOnly);
    groups_[kSmall].program = groups_[kBlended].program = table_program(shaders::kTheRest);
    groups_[kFloor].program = table_program(shaders::kFloorOnly);
    for (Group& group : groups_) group.jitter = api.GetUniformLocation(group.program, "u_jitter");
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

void StaticLayer::upload(const TableMesh& table) {
    const auto part_of = [](const MeshVertex& vertex) {
        const auto material = static_cast<Material>(static_cast<int>(vertex.material));
        if (material == Material::kCloth || material == Material::kCushion) return kCloth;
        if (material == Material::kFloor) return kFloor;
        return material == Material::kWood ? kWood : kSmall;
    };
    std::vector<MeshVertex> all;
    for (int part = kCloth; part < kParts; ++part) {
        const auto first = static_cast<GLint>(all.size());
        for (const MeshVertex& vertex : part == kBlended ? table.blended : table.solid) {
            if (part == kBlended || part_of(vertex) == part) all.push_back(vertex);
        }
        groups_[part].first = first;
        groups_[part].count = static_cast<GLsizei>(all.size()) - first;
    }
    api_.BindVertexArray(vertex_array_);
    api_.BindBuffer(GL_ARRAY_BUFFER, buffer_);
    api_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(all.size() * sizeof(MeshVertex)), all.data(),
                    GL_STATIC_DRAW);
    const auto attribute = [&](GLuint index, std::size_t offset) {
        api_.EnableVertexAttribArray(index);
        api_.VertexAttribPointer(index, 3, GL_FLOAT, GL_FALSE, sizeof(MeshVertex), gl::buffer_offset(offset));
    };
    attribute(0, offsetof(MeshVertex, x));
    attribute(1, offsetof(MeshVertex, nx));
    attribute(2, offsetof(MeshVertex, u));
    for (const Group& group : groups_) set_table_uniforms(table, group.program);
    uploaded_ = &table;
}

void StaticLayer::resize(int width, int height) {
    if (width == width_ && height == height_) return;
    scratch_.reset();
    if (color_ != 0) {
        const GLuint textures[] = {color_, occluders_},
                     framebuffers[] = {color_framebuffer_, occluders_framebuffer_};
        api_.DeleteFramebuffers(2, framebuffers);
        api_.DeleteTextures(2, textures);
    }
    color_ = gl::make_texture(api_, width, height, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    occluders_ = gl::make_texture(api_, width, height, GL_RGBA32F, GL_RGBA, GL_FLOAT, nullptr);
    color_framebuffer_ = gl::make_framebuffer(api_, color_, 0);
    occluders_framebuffer_ = gl::make_framebuffer(api_, occluders_, 0);
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
    double clear_low = table.inner_low.x(), clear_high = table.inner_high.x();
    for (const Hole& hole : table.holes) {
        const bool left = hole.center.x() < 0.5 * (table.inner_low.x() + table.inner_high.x());
        if (left)
            clear_low = std::max(clear_low, hole.center.x() + hole.radius);
        else
            clear_high = std::min(clear_high, hole.center.x() - hole.radius);
    }
    api_.Uniform2f(at("u_clear"), static_cast<float>(clear_low - table.origin.x()),
                   static_cast<float>(clear_high - table.origin.x()));
    const auto count = static_cast<GLsizei>(holes.size() / 4);
    if (count > 0) api_.Uniform4fv(at("u_holes"), count, holes.data());
    api_.Uniform1i(at("u_hole_count"), count);
    const Vec2 low = table.inner_low - table.origin, high = table.inner_high - table.origin;
    api_.Uniform4f(at("u_inner"), static_cast<float>(low.x()), static_cast<float>(low.y()),
                   static_cast<float>(high.x()), static_cast<float>(high.y()));
}

void StaticLayer::draw_pass(const Scratch& scratch, int pass, int samples) {
    // The steps of the R2 sequence are 1 / p and 1 / p^2, with the plastic number p.
    const double jx = samples == 1 ? 0.0 : r2(pass, 0.75487766624669276),
                 jy = samples == 1 ? 0.0 : r2(pass, 0.56984029099805327);
    api_.BindFramebuffer(GL_FRAMEBUFFER, scratch.pass_framebuffer[scratch.slot(pass)]);
    api_.DepthMask(GL_TRUE);
    api_.ClearColor(0.004F, 0.004F, 0.004F, 0.0F);
    api_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    api_.Enable(GL_DEPTH_TEST);
    api_.DepthFunc(GL_LEQUAL);
    api_.Disable(GL_BLEND);
    api_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    api_.BindVertexArray(vertex_array_);
    for (const Group& group : groups_) {
        // These are blended over the cloth and keep its alpha, which marks cloth.
        if (&group == &groups_[kBlended]) {
            api_.Enable(GL_BLEND);
            api_.DepthMask(GL_FALSE);
        }
        api_.UseProgram(group.program);
        api_.Uniform2f(group.jitter, static_cast<float>(2.0 * jx / width_),
                       static_cast<float>(2.0 * jy / height_));
        api_.DrawArrays(GL_TRIANGLES, group.first, group.count);
    }
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

void StaticLayer::draw(const TableMesh& table, FrameSize size, int samples, bool again_soon,
                       const std::function<void(int, int)>& on_pass) {
    samples = std::max(samples, 1);
    if (uploaded_ != &table) upload(table);
    resize(size.width, size.height);
    if (!scratch_) scratch_ = std::make_unique<Scratch>(api_, width_, height_);
    const Scratch& scratch = *scratch_;
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
    if (!again_soon) scratch_.reset();
}

}  // namespace carom::render
