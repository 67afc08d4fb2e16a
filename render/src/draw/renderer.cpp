#include "carom/render/renderer.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "carom/render/error.h"
#include "draw/drawn_balls.h"
#include "draw/edge_smoother.h"
#include "draw/overlay_layer.h"
#include "draw/shaders.h"
#include "draw/static_layer.h"
#include "draw/view.h"
#include "font/glyphs.h"
#include "gl/context.h"
#include "gl/objects.h"

namespace carom::render {

struct Renderer::Impl {
    std::unique_ptr<gl::Context> context;
    gl::Api api;
    std::unique_ptr<StaticLayer> table_layer;
    std::unique_ptr<OverlayLayer> overlay_layer;
    /// The balls of one shader variant. Balls over cloth alone (`plain`) need no lookups in the table's textures.
    struct BallBatch {
        GLuint shadow_program = 0, ball_program = 0, array = 0, buffer = 0;
        std::vector<BallInstance> instances;
    };
    BallBatch plain;
    // Balls that the table may hide, and those of them that stand near a cushion, which gets a shadow.
    struct OtherBalls {
        BallBatch balls, beside;
    };
    OtherBalls still, moving;  // for a table with many samples, and with one
    GLuint glyphs = 0, view_buffer = 0;
    // Two images are used alternately: one can be read while the next one is drawn.
    struct Target {
        GLuint color = 0, framebuffer = 0;
        std::shared_ptr<const DrawnPicture> shows = std::make_shared<DrawnPicture>();
    };
    std::array<Target, 2> targets;
    std::size_t current = 0;  // the target of the last draw()
    FrameSize size{0, 0};
    std::shared_ptr<const TableMesh> table;  // the mesh that the static layer shows
    Camera camera;
    int table_samples = 0;
    bool camera_moves = false;
    std::function<void(int, int)> on_table;
    std::shared_ptr<const TableDrawing> drawn_table;  // identifies the drawing in the static layer
    ClothMap cloth;
    std::vector<std::uint8_t> table_pixels;

    explicit Impl(Backend backend) : context(gl::make_context(backend)) {
        context->make_current();
        api = gl::load_api(context->lookup());
        table_layer = std::make_unique<StaticLayer>(api);
        const std::vector<std::uint8_t> atlas = glyph_atlas();
        glyphs = gl::make_texture(api, kGlyphColumns * kGlyphWidth, kGlyphRows * kGlyphHeight, GL_R8, GL_RED,
                                  GL_UNSIGNED_BYTE, atlas.data(), true);
        overlay_layer = std::make_unique<OverlayLayer>(api, glyphs);
        api.GenBuffers(1, &view_buffer);
        make_batch(plain, shaders::kPlain, shaders::kPlain);
    }

    void make_batch(BallBatch& batch, const std::string& shadow_defines, const std::string& ball_defines) {
        if (batch.array != 0) return;
        batch.shadow_program = shaders::make_program(api, shaders::kShadowVertex, shaders::kShadowFragment,
                                                     {"u_occluders", "u_background"}, shadow_defines);
        batch.ball_program = shaders::make_program(api, shaders::kBallVertex, shaders::kBallFragment,
                                                   {"u_occluders", "u_glyphs"}, ball_defines);
        api.GenVertexArrays(1, &batch.array);
        api.GenBuffers(1, &batch.buffer);
        api.BindVertexArray(batch.array);
        api.BindBuffer(GL_ARRAY_BUFFER, batch.buffer);
        const auto attribute = [&](GLuint index, GLint count, std::size_t offset) {
            api.EnableVertexAttribArray(index);
            api.VertexAttribPointer(index, count, GL_FLOAT, GL_FALSE, sizeof(BallInstance),
                                    gl::buffer_offset(offset));
            api.VertexAttribDivisor(index, 1);
        };
        attribute(0, 4, offsetof(BallInstance, center_radius));
        attribute(1, 4, offsetof(BallInstance, orientation));
        attribute(2, 4, offsetof(BallInstance, color_number));
        attribute(3, 3, offsetof(BallInstance, pattern));
        for (int i = 0; i < shaders::kMaxNear; ++i) {
            attribute(
                4 + static_cast<GLuint>(i), 4,
                offsetof(BallInstance, near) + static_cast<std::size_t>(i) * sizeof(BallInstance::near[0]));
        }
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
            target.shows = std::make_shared<DrawnPicture>();
        }
        size = wanted;
    }

    // Fills both batches with the chosen balls.
    void upload(const std::vector<DrawnBall>& balls, const std::vector<bool>& chosen, OtherBalls& others) {
        plain.instances.clear();
        others.balls.instances.clear();
        others.beside.instances.clear();
        for (std::size_t i = 0; i < balls.size(); ++i) {
            if (!chosen[i]) continue;
            const BallInstance& instance = balls[i].instance;
            (balls[i].plain ? plain : others.balls).instances.push_back(instance);
            if (instance.pattern[1] == static_cast<float>(BallPlace::kCushion))
                others.beside.instances.push_back(instance);
        }
        for (BallBatch* batch : {&plain, &others.balls, &others.beside}) {
            if (batch->instances.empty()) continue;
            api.BindBuffer(GL_ARRAY_BUFFER, batch->buffer);
            api.BufferData(GL_ARRAY_BUFFER,
                           static_cast<GLsizeiptr>(batch->instances.size() * sizeof(BallInstance)),
                           batch->instances.data(), GL_STREAM_DRAW);
        }
    }

    // Draws the octagons of a batch with the program that is in use.
    void draw_round(const BallBatch& batch) {
        api.BindVertexArray(batch.array);
        api.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, shaders::kRoundCorners,
                                static_cast<GLsizei>(batch.instances.size()));
    }

    void draw_shadows(const BallBatch& batch) {
        if (batch.instances.empty()) return;
        api.UseProgram(batch.shadow_program);
        gl::bind_texture(api, 0, table_layer->occluders());
        gl::bind_texture(api, 1, table_layer->color());
        draw_round(batch);
    }

    void draw_balls(const BallBatch& batch) {
        if (batch.instances.empty()) return;
        api.UseProgram(batch.ball_program);
        gl::bind_texture(api, 0, table_layer->occluders());
        gl::bind_texture(api, 1, glyphs);
        draw_round(batch);
    }

    void draw_table(const DrawList& list) {
        if (table == list.table && camera == list.camera && table_samples == list.table_samples &&
            camera_moves == list.camera_moves) {
            return;
        }
        table = nullptr;  // until the drawing is complete: on_table may throw
        if (list.camera_moves)
            table_layer->draw_once(*list.table, size);
        else
            table_layer->draw(*list.table, size, list.table_samples, on_table);
        table = list.table;
        camera = list.camera;
        table_samples = list.table_samples;
        camera_moves = list.camera_moves;
        drawn_table = std::make_shared<TableDrawing>();
        cloth = ClothMap();
        // With a camera that moves, the cloth map would be valid for one frame only: it is not made.
        if (camera_moves) return;
        table_pixels.resize(std::size_t{4} * static_cast<std::size_t>(size.width) *
                            static_cast<std::size_t>(size.height));
        read_boxes(table_layer->framebuffer(), {{0, 0, size.width, size.height}}, table_pixels.data());
        cloth = ClothMap(table_pixels, size);
        table_pixels = {};
    }

    // Copies the picture of the table into the boxes.
    void restore_table(const std::vector<PixelBox>& boxes, const Target& target) {
        api.BindFramebuffer(GL_READ_FRAMEBUFFER, table_layer->framebuffer());
        api.BindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer);
        for (const PixelBox& box : boxes) {
            api.BlitFramebuffer(box.x0, box.y0, box.x1, box.y1, box.x0, box.y0, box.x1, box.y1,
                                GL_COLOR_BUFFER_BIT, GL_NEAREST);
        }
    }

    void draw(const DrawList& list) {
        context->make_current();
        const View view = make_view(list.camera, *list.table);
        api.BindBufferBase(GL_UNIFORM_BUFFER, 0, view_buffer);
        api.BufferData(GL_UNIFORM_BUFFER, sizeof view, &view, GL_STREAM_DRAW);
        resize(list.camera.size);
        draw_table(list);
        api.Viewport(0, 0, size.width, size.height);
        current = 1 - current;
        Target& target = targets[current];
        auto next = std::make_shared<DrawnPicture>();
        next->table = drawn_table;
        next->balls = visible_balls(list, cloth);
        next->shapes = drawn_shapes(list);
        if (camera_moves) next->edges = edges_to_smooth(list, view);
        OtherBalls& others = camera_moves ? moving : still;
        const std::string samples = camera_moves ? shaders::kOneSample : shaders::kManySamples;
        make_batch(others.balls, samples, samples);
        make_batch(others.beside, samples + shaders::kBeside, samples);
        std::vector<PixelBox> boxes = differing_boxes(*target.shows, *next, size);
        const Inside redrawn = inside(*next, boxes, size);
        upload(next->balls, redrawn.balls, others);
        restore_table(boxes, target);
        const DrawList overlay = part_of(list, redrawn.shapes);
        target.shows = std::move(next);

        api.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
        api.Disable(GL_DEPTH_TEST);
        api.Enable(GL_BLEND);
        draw_over_table(overlay, others);
    }

    // The chosen ones of the lines and, behind these, the boxes of a list.
    static DrawList part_of(const DrawList& list, const std::vector<bool>& chosen) {
        DrawList part;
        part.table = list.table;
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            if (!chosen[i]) continue;
            if (i < list.lines.size())
                part.lines.push_back(list.lines[i]);
            else
                part.boxes.push_back(list.boxes[i - list.lines.size()]);
        }
        return part;
    }

    void draw_over_table(const DrawList& list, const OtherBalls& others) {
        // Under a camera that moves, alpha is the mark of the face. It stays under a shadow, and falls to 0 under what
        // is painted over the table, because the edges of the table are not seen there.
        // Shadows only darken. The same blend factor for all channels is a fast path of the driver.
        api.BlendFuncSeparate(GL_ZERO, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO,
                              camera_moves ? GL_ONE : GL_ONE_MINUS_SRC_ALPHA);
        draw_shadows(plain);
        draw_shadows(others.balls);
        draw_shadows(others.beside);
        api.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, camera_moves ? GL_ZERO : GL_SRC_ALPHA,
                              GL_ONE_MINUS_SRC_ALPHA);
        const OverlayLayer::Occluders occluders{table_layer->occluders(), camera_moves};
        overlay_layer->draw_lines(list, occluders, LineLayer::kUnderBalls);
        draw_balls(plain);
        draw_balls(others.balls);
        overlay_layer->draw_lines(list, occluders, LineLayer::kOverBalls);
        overlay_layer->draw_boxes(list);
    }

    std::shared_ptr<const EdgesInView> edges_to_smooth(const DrawList& list, const View& view) const {
        auto edges = std::make_shared<EdgesInView>(EdgesInView{table_layer->edges(), view, {}});
        for (const DrawBox& box : list.boxes) {
            if (box.glyph >= 0) continue;
            edges->skip.push_back({static_cast<int>(box.low.x()), static_cast<int>(box.low.y()),
                                   static_cast<int>(box.high.x()) + 1, static_cast<int>(box.high.y()) + 1});
        }
        return edges;
    }

    void read_boxes(GLuint framebuffer, const std::vector<PixelBox>& boxes, std::uint8_t* rgba) {
        api.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        api.PixelStorei(GL_PACK_ALIGNMENT, 4);
        api.PixelStorei(GL_PACK_ROW_LENGTH, size.width);
        for (const PixelBox& box : boxes) {
            const std::size_t first =
                static_cast<std::size_t>(box.y0) * static_cast<std::size_t>(size.width) +
                static_cast<std::size_t>(box.x0);
            api.ReadPixels(box.x0, box.y0, box.x1 - box.x0, box.y1 - box.y0, GL_RGBA, GL_UNSIGNED_BYTE,
                           rgba + 4 * first);
        }
    }

    void read(const Target& target, Image& image, std::shared_ptr<const DrawnPicture>& shows) {
        context->make_current();
        if (!(image.size == size)) shows.reset();
        image.resize(size);
        read_boxes(target.framebuffer, differing_boxes(shows ? *shows : DrawnPicture{}, *target.shows, size),
                   image.rgbx.data());
        shows = target.shows;
        if (const auto& smooth = target.shows->edges)
            smooth_edges(image, smooth->table->edges, smooth->view, smooth->skip);
    }
};

Renderer::Renderer(Backend backend) : impl_(std::make_unique<Impl>(backend)) {}

Renderer::~Renderer() = default;

void Renderer::draw(const DrawList& list) {
    impl_->draw(list);
    impl_->api.Flush();
}

void Renderer::on_table(std::function<void(int, int)> pass) {
    impl_->on_table = std::move(pass);
}

void Renderer::finish() {
    impl_->context->make_current();
    impl_->api.Finish();
}

void Renderer::read(Image& image) {
    std::shared_ptr<const DrawnPicture> nothing;
    impl_->read(impl_->targets[impl_->current], image, nothing);
}

void Renderer::read(KeptImage& image) {
    impl_->read(impl_->targets[impl_->current], image.image_, image.shows_);
}

void Renderer::read_previous(KeptImage& image) {
    impl_->read(impl_->targets[1 - impl_->current], image.image_, image.shows_);
}

}  // namespace carom::render
