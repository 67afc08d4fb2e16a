#include "carom/render/renderer.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <variant>
#include <vector>

#include "carom/render/error.h"
#include "draw/canvas.h"
#include "draw/drawn_balls.h"
#include "draw/edge_smoother.h"
#include "draw/paint_shapes.h"
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
    const std::vector<std::uint8_t>& glyphs = glyph_atlas();
    GLuint view_buffer = 0;
    Image image;                                                                   // the last draw()
    std::shared_ptr<const DrawnPicture> shows = std::make_shared<DrawnPicture>();  // what the image shows
    FrameSize size{0, 0};
    std::shared_ptr<const TableMesh> table;  // the mesh that the static layer shows
    Camera camera;
    int table_samples = 0;
    bool camera_moves = false, less_detail = false;
    std::function<void(int, int)> on_table;
    std::shared_ptr<const TableDrawing> drawn_table;  // identifies the drawing in the static layer
    ClothMap cloth;

    explicit Impl(Backend backend) : context(gl::make_context(backend)) {
        context->make_current();
        api = gl::load_api(context->lookup());
        table_layer = std::make_unique<StaticLayer>(api);
        api.GenBuffers(1, &view_buffer);
    }

    void resize(FrameSize wanted) {
        if (wanted == size) return;
        if (wanted.width < 1 || wanted.height < 1) throw RenderError("an image needs at least one pixel");
        image.resize(wanted);
        shows = std::make_shared<DrawnPicture>();
        size = wanted;
    }

    void draw_table(const DrawList& list, const View& view) {
        if (table == list.table && camera == list.camera && table_samples == list.table_samples &&
            camera_moves == list.camera_moves && less_detail == list.less_detail) {
            return;
        }
        context->make_current();
        api.BindBufferBase(GL_UNIFORM_BUFFER, 0, view_buffer);
        api.BufferData(GL_UNIFORM_BUFFER, sizeof view, &view, GL_STREAM_DRAW);
        table = nullptr;  // until the drawing is complete: on_table may throw
        if (list.camera_moves)
            table_layer->draw_once(*list.table, size, list.less_detail);
        else
            table_layer->draw(*list.table, view, size, list.table_samples, list.less_detail, on_table);
        table = list.table;
        camera = list.camera;
        table_samples = list.table_samples;
        camera_moves = list.camera_moves;
        less_detail = list.less_detail;
        drawn_table = std::make_shared<TableDrawing>();
        cloth = ClothMap();
        // With a moving camera, the cloth map would be valid for one frame only, so it is not made.
        if (camera_moves) return;
        cloth = ClothMap(table_layer->picture().rgba, size);
    }

    // Copies the contents of the boxes.
    static void copy_boxes(const std::vector<std::uint8_t>& from, const std::vector<PixelBox>& boxes,
                           Image& image) {
        for (const PixelBox& box : boxes) {
            for (int y = box.y0; y < box.y1; ++y) {
                const std::size_t first =
                    4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.size.width) +
                         static_cast<std::size_t>(box.x0));
                std::memcpy(image.rgbx.data() + first, from.data() + first,
                            4 * static_cast<std::size_t>(box.x1 - box.x0));
            }
        }
    }

    void draw(const DrawList& list) {
        const View view = make_view(list.camera, *list.table);
        resize(list.camera.size);
        draw_table(list, view);
        auto next = std::make_shared<DrawnPicture>();
        next->table = drawn_table;
        next->balls = visible_balls(list, cloth);
        next->shapes = drawn_shapes(list);
        if (camera_moves) next->edges = edges_to_smooth(list, view);
        std::vector<PixelBox> boxes = differing_boxes(*shows, *next, size);
        const Inside redrawn = inside(*next, boxes, size);
        copy_boxes(table_layer->picture().rgba, boxes, image);
        paint(*next, redrawn, Canvas(image, table_layer->picture(), view), list.table->origin);
        shows = std::move(next);
    }

    // Paints what a picture shows over the table, where it must be redrawn.
    void paint(const DrawnPicture& picture, const Inside& redrawn, const Canvas& canvas,
               const Vec2& origin) const {
        const auto each_ball = [&](const auto& paint_one) {
            for (std::size_t i = 0; i < picture.balls.size(); ++i) {
                if (redrawn.balls[i]) paint_one(picture.balls[i]);
            }
        };
        const auto lines = [&](LineLayer layer) {
            for (std::size_t i = 0; i < picture.shapes.size(); ++i) {
                const auto* line = std::get_if<DrawLine>(&picture.shapes[i].what);
                if (redrawn.shapes[i] && line != nullptr && line->layer == layer)
                    paint_line(canvas, *line, picture.shapes[i].box, origin);
            }
        };
        const DrawCue* const cue = picture.shapes.empty() || !redrawn.shapes[0]
                                       ? nullptr
                                       : std::get_if<DrawCue>(&picture.shapes[0].what);
        const auto balls_before = [&](bool before) {
            each_ball([&](const DrawnBall& ball) {
                if (before == (cue != nullptr && is_before(ball, *cue, canvas.view(), origin)))
                    paint_ball(canvas, ball, glyphs);
            });
        };
        each_ball([&](const DrawnBall& ball) { paint_shadow(canvas, ball); });
        if (cue != nullptr) paint_cue_shadow(canvas, *cue, picture.shapes[0].box, origin);
        lines(LineLayer::kUnderBalls);
        balls_before(false);
        if (cue != nullptr) paint_cue(canvas, *cue, picture.shapes[0].box, origin);
        balls_before(true);
        lines(LineLayer::kOverBalls);
        for (std::size_t i = 0; i < picture.shapes.size(); ++i) {
            const auto* box = std::get_if<DrawBox>(&picture.shapes[i].what);
            if (redrawn.shapes[i] && box != nullptr) paint_box(canvas, *box, picture.shapes[i].box, glyphs);
        }
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

    void read(Image& copy, std::shared_ptr<const DrawnPicture>& copy_shows) const {
        if (!(copy.size == size)) copy_shows.reset();
        copy.resize(size);
        copy_boxes(image.rgbx, differing_boxes(copy_shows ? *copy_shows : DrawnPicture{}, *shows, size),
                   copy);
        copy_shows = shows;
        if (const auto& smooth = shows->edges)
            smooth_edges(copy, smooth->table->edges, smooth->view, smooth->skip);
    }
};

Renderer::Renderer(Backend backend) : impl_(std::make_unique<Impl>(backend)) {}

Renderer::~Renderer() = default;

void Renderer::draw(const DrawList& list) {
    impl_->draw(list);
}

void Renderer::on_table(std::function<void(int, int)> pass) {
    impl_->on_table = std::move(pass);
}

void Renderer::read(Image& image) {
    std::shared_ptr<const DrawnPicture> nothing;
    impl_->read(image, nothing);
}

void Renderer::read(KeptImage& image) {
    impl_->read(image.image_, image.shows_);
}

}  // namespace carom::render
