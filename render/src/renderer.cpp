#include "carom/render/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "carom/render/error.h"
#include "gl_context.h"
#include "gl_objects.h"
#include "glyphs.h"
#include "overlay_layer.h"
#include "shaders.h"
#include "static_layer.h"

namespace carom::render {

namespace {

// What the ball shaders read, one per ball.
struct BallInstance {
    float center_radius[4];
    float orientation[4];
    float color_number[4];
    float pattern[3];
};

// How far a shadow's quad reaches, in radii; the shader has the same number.
constexpr double kShadowReach = 2.5;

float linear(float srgb) {
    return srgb * srgb;  // the shaders' gamma
}

BallInstance make_instance(const DrawBall& ball, const Vec3& origin, double distance) {
    const auto f = [](double value) { return static_cast<float>(value); };
    const Vec3 center = ball.center - origin;
    const Eigen::Quaterniond& q = ball.orientation;
    const BallStyle& style = ball.style;
    return {{f(center.x()), f(center.y()), f(center.z()), f(ball.radius)},
            {f(q.x()), f(q.y()), f(q.z()), f(q.w())},
            {linear(style.color[0]), linear(style.color[1]), linear(style.color[2]),
             static_cast<float>(style.number)},
            {static_cast<float>(style.pattern), ball.in_pocket ? 1.0F : 0.0F, f(distance)}};
}

/// Columns x0..x1-1 and rows y0..y1-1.
struct PixelBox {
    int x0, y0, x1, y1;
};

// Pixels that a ball and its shadow may touch; the whole image if part of them is behind the eye.
PixelBox box_of(const DrawBall& ball, const Camera& camera) {
    const double reach = (ball.in_pocket ? 1.0 : kShadowReach) * ball.radius;
    const PixelBox all{0, 0, camera.size.width, camera.size.height};
    Vec2 low(1e9, 1e9), high(-1e9, -1e9);
    for (int i = 0; i < 8; ++i) {
        const Vec3 corner = ball.center + Vec3((i & 1) ? reach : -reach, (i & 2) ? reach : -reach,
                                               (i & 4) ? ball.radius : -ball.radius);
        const std::optional<Vec2> pixel = camera.project(corner);
        if (!pixel) return all;
        low = low.cwiseMin(*pixel);
        high = high.cwiseMax(*pixel);
    }
    const auto inside = [](double value, int limit) {
        return static_cast<int>(std::clamp(value, 0.0, double(limit)));
    };
    return {inside(low.x() - 2.0, all.x1), inside(low.y() - 2.0, all.y1), inside(high.x() + 3.0, all.x1),
            inside(high.y() + 3.0, all.y1)};
}

std::vector<PixelBox> touched_boxes(const DrawList& list) {
    const PixelBox all{0, 0, list.camera.size.width, list.camera.size.height};
    if (!list.lines.empty() || !list.boxes.empty()) return {all};
    std::vector<PixelBox> boxes;
    for (const DrawBall& ball : list.balls) {
        const PixelBox box = box_of(ball, list.camera);
        if (box.x1 > box.x0 && box.y1 > box.y0) boxes.push_back(box);
    }
    return boxes;
}

}  // namespace

struct Renderer::Impl {
    std::unique_ptr<gl::Context> context;
    gl::Api api;
    std::unique_ptr<StaticLayer> table_layer;
    std::unique_ptr<OverlayLayer> overlay_layer;
    GLuint shadow_program = 0, ball_program = 0, glyphs = 0;
    GLuint ball_array = 0, ball_buffer = 0;
    // Two images in turn: one can be read while the next is drawn.
    struct Target {
        GLuint color = 0, framebuffer = 0;
        std::vector<PixelBox> drawn;  // what its last frame put over the table
    };
    std::array<Target, 2> targets;
    std::size_t current = 0;  // the target of the last draw()
    FrameSize size{0, 0};
    std::shared_ptr<const TableMesh> table;  // of the static layer
    Camera camera;
    int table_samples = 0;

    explicit Impl(Backend backend) : context(gl::make_context(backend)) {
        context->make_current();
        api = gl::load_api(context->lookup());
        table_layer = std::make_unique<StaticLayer>(api);
        shadow_program = gl::make_program(api, shaders::kShadowVertex, shaders::kShadowFragment);
        ball_program = gl::make_program(api, shaders::kBallVertex, shaders::kBallFragment);
        const std::vector<std::uint8_t> atlas = glyph_atlas();
        glyphs = gl::make_texture(api, kGlyphColumns * kGlyphWidth, kGlyphRows * kGlyphHeight, GL_R8, GL_RED,
                                  GL_UNSIGNED_BYTE, atlas.data(), true);
        overlay_layer = std::make_unique<OverlayLayer>(api, glyphs);
        make_ball_array();
    }

    void make_ball_array() {
        api.GenVertexArrays(1, &ball_array);
        api.GenBuffers(1, &ball_buffer);
        api.BindVertexArray(ball_array);
        api.BindBuffer(GL_ARRAY_BUFFER, ball_buffer);
        const auto attribute = [&](GLuint index, GLint count, std::size_t offset) {
            api.EnableVertexAttribArray(index);
            api.VertexAttribPointer(index, count, GL_FLOAT, GL_FALSE, sizeof(BallInstance),
                                    reinterpret_cast<const void*>(offset));
            api.VertexAttribDivisor(index, 1);
        };
        attribute(0, 4, offsetof(BallInstance, center_radius));
        attribute(1, 4, offsetof(BallInstance, orientation));
        attribute(2, 4, offsetof(BallInstance, color_number));
        attribute(3, 3, offsetof(BallInstance, pattern));
    }

    void resize(FrameSize wanted) {
        if (wanted == size) return;
        if (wanted.width < 1 || wanted.height < 1) throw RenderError("an image needs at least one pixel");
        for (Target& target : targets) {
            if (target.color != 0) {
                api.DeleteFramebuffers(1, &target.framebuffer);
                api.DeleteTextures(1, &target.color);
            }
            target.color = gl::make_texture(api, wanted.width, wanted.height, GL_RGBA8, GL_RGBA,
                                            GL_UNSIGNED_BYTE, nullptr);
            target.framebuffer = gl::make_framebuffer(api, target.color, 0);
        }
        size = wanted;
    }

    // Far balls first, so that near ones blend their soft edges over them.
    GLsizei upload_balls(const DrawList& list) {
        const Vec3 origin(list.table->origin.x(), list.table->origin.y(), 0.0);
        std::vector<BallInstance> instances;
        for (const DrawBall& ball : list.balls) {
            const double distance = (ball.center - list.camera.eye).norm();
            // An eye inside a ball, or past it, sees nothing of it.
            if (distance > 1.05 * ball.radius && list.camera.depth(ball.center) > -ball.radius) {
                instances.push_back(make_instance(ball, origin, distance));
            }
        }
        std::stable_sort(
            instances.begin(), instances.end(),
            [](const BallInstance& a, const BallInstance& b) { return a.pattern[2] > b.pattern[2]; });
        api.BindBuffer(GL_ARRAY_BUFFER, ball_buffer);
        api.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances.size() * sizeof(BallInstance)),
                       instances.data(), GL_STREAM_DRAW);
        return static_cast<GLsizei>(instances.size());
    }

    // Puts the table back where the last frame drew something, and notes where this one will.
    void restore_table(const DrawList& list, Target& target) {
        api.BindFramebuffer(GL_READ_FRAMEBUFFER, table_layer->framebuffer());
        api.BindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer);
        for (const PixelBox& box : target.drawn) {
            api.BlitFramebuffer(box.x0, box.y0, box.x1, box.y1, box.x0, box.y0, box.x1, box.y1,
                                GL_COLOR_BUFFER_BIT, GL_NEAREST);
        }
        target.drawn = touched_boxes(list);
    }

    void draw(const DrawList& list) {
        context->make_current();
        const View view = make_view(list.camera, *list.table);
        if (table != list.table || !(camera == list.camera) || table_samples != list.table_samples) {
            table_layer->draw(*list.table, view, list.table_samples);
            table = list.table;
            camera = list.camera;
            table_samples = list.table_samples;
            for (Target& target : targets) {
                target.drawn.assign(1, PixelBox{0, 0, list.camera.size.width, list.camera.size.height});
            }
        }
        resize(list.camera.size);
        api.Viewport(0, 0, size.width, size.height);
        current = 1 - current;
        restore_table(list, targets[current]);
        api.BindFramebuffer(GL_FRAMEBUFFER, targets[current].framebuffer);
        api.Disable(GL_DEPTH_TEST);
        api.Enable(GL_BLEND);
        api.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        const GLsizei balls = upload_balls(list);
        if (balls > 0) {
            api.BindVertexArray(ball_array);
            // Shadows only darken: one factor for all channels is the driver's fast way.
            api.BlendFuncSeparate(GL_ZERO, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
            view.set(api, shadow_program);
            gl::bind_texture(api, shadow_program, 0, "u_background", table_layer->color());
            api.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 8, balls);
        }
        api.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        overlay_layer->draw_lines(list, view, table_layer->occluders(), false);
        if (balls > 0) {
            api.BindVertexArray(ball_array);
            view.set(api, ball_program);
            gl::bind_texture(api, ball_program, 0, "u_occluders", table_layer->occluders());
            gl::bind_texture(api, ball_program, 1, "u_glyphs", glyphs);
            api.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 8, balls);
        }
        overlay_layer->draw_lines(list, view, table_layer->occluders(), true);
        overlay_layer->draw_boxes(list, view);
    }

    void read(Image& image, bool previous) {
        context->make_current();
        image.resize(size);
        api.BindFramebuffer(GL_FRAMEBUFFER, targets[previous ? 1 - current : current].framebuffer);
        api.PixelStorei(GL_PACK_ALIGNMENT, 4);
        api.ReadPixels(0, 0, size.width, size.height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgbx.data());
    }
};

Renderer::Renderer(Backend backend) : impl_(std::make_unique<Impl>(backend)) {}

Renderer::~Renderer() = default;

void Renderer::draw(const DrawList& list) {
    impl_->draw(list);
    impl_->api.Flush();
}

void Renderer::finish() {
    impl_->context->make_current();
    impl_->api.Finish();
}

void Renderer::read(Image& image) {
    impl_->read(image, false);
}

void Renderer::read_previous(Image& image) {
    impl_->read(image, true);
}

std::string Renderer::description() const {
    const auto text = [this](GLenum what) {
        return std::string(reinterpret_cast<const char*>(impl_->api.GetString(what)));
    };
    return text(GL_VERSION) + ", " + text(GL_RENDERER);
}

}  // namespace carom::render
