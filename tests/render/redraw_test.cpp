// Frames that are drawn and read back only in part have the pixels of whole frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/simulate.h"
#include "carom/render/renderer.h"
#include "draw/drawn_balls.h"
#include "render/hand_made.h"

namespace carom::render {
namespace {

const Record& rack_to_redraw() {
    static const Record record = [] {
        const Scene scene = read_scene(std::string(CAROM_SOURCE_DIR) + "/scenes/eight_ball_break.toml");
        return simulate(make_plan(scene, kernel::Isa::kScalar));
    }();
    return record;
}

Stage stage_of(const std::string& camera, const std::string& overlay = "") {
    StageOptions options;
    options.camera = camera;
    options.overlay = parse_overlay(overlay);
    options.size = {480, 270};
    options.table_samples = 2;
    return Stage(rack_to_redraw(), options);
}

// Draws from scratch: a first picture from another camera makes both targets worthless.
Image whole_picture(Renderer& renderer, const DrawList& list) {
    DrawList elsewhere = list;
    elsewhere.table_samples = 1;
    elsewhere.camera.eye.x() += 0.1;
    renderer.draw(elsewhere);
    renderer.draw(list);
    Image image;
    renderer.read(image);
    return image;
}

// Steps from the rack to rest: resting balls among moving ones, pockets, balls that meet in the picture.
std::vector<double> instants() {
    std::vector<double> times;
    for (double t : {0.0, 0.02, 0.1, 0.1, 0.3, 0.9, 2.0, 2.05, 3.5, 5.0, 0.3}) times.push_back(t);
    times.push_back(rack_to_redraw().duration);
    times.push_back(rack_to_redraw().duration);
    return times;
}

class Redraw : public ::testing::TestWithParam<const char*> {};

TEST_P(Redraw, PartsHaveThePixelsOfTheWhole) {
    const Stage stage = stage_of(GetParam());
    Renderer renderer, reference;
    KeptImage image;
    for (const double t : instants()) {
        const DrawList list = stage.at(t);
        renderer.draw(list);
        renderer.read(image);
        EXPECT_TRUE(render_test::same_pixels(image.image(), whole_picture(reference, list))) << t;
    }
}

// Frame after frame, as in a film, with lines that grow, fade, and pass over and under the balls.
TEST_P(Redraw, OverlaysHaveThePixelsOfTheWhole) {
    for (const char* overlay : {"events,spin,ghost,clock", "trails,margin"}) {
        const Stage stage = stage_of(GetParam(), overlay);
        Renderer renderer, reference;
        std::array<KeptImage, 2> images;
        for (int k = 0; k < 24; ++k) {
            const double t = (k < 12 ? 0.2 : 2.0) + k / 60.0;
            const DrawList list = stage.at(t, FrameBudget{3.0 + 0.5 * k, 16.0});
            KeptImage& image = images[static_cast<std::size_t>(k % 2)];
            renderer.draw(list);
            renderer.read(image);
            EXPECT_TRUE(render_test::same_pixels(image.image(), whole_picture(reference, list)))
                << overlay << t;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Cameras, Redraw, ::testing::Values("top", "rail", "player", "follow"),
                         [](const auto& camera) { return std::string(camera.param); });

TEST(RedrawLines, ATemporaryOverlayLeavesNoTrace) {
    const Stage bare = stage_of("rail"), lines = stage_of("rail", "trails,clock");
    Renderer renderer, reference;
    KeptImage image;
    int shown = 0;
    for (const double t : {0.2, 0.4, 0.5, 0.6, 0.7, 0.8}) {
        // Each stage has its own table; sharing one avoids redrawing everything.
        DrawList list = (++shown % 3 == 0 ? lines : bare).at(t);
        list.table = bare.table();
        renderer.draw(list);
        renderer.read(image);
        EXPECT_TRUE(render_test::same_pixels(image.image(), whole_picture(reference, list))) << t;
    }
}

// A renderer that draws at another size recreates its targets without leftovers of the old ones.
TEST(RedrawLines, TheSizeMayChange) {
    StageOptions options;
    options.camera = "top";
    options.table_samples = 2;
    Renderer renderer;
    for (const FrameSize size : {FrameSize{160, 90}, FrameSize{200, 120}, FrameSize{160, 90}}) {
        options.size = size;
        Renderer fresh;
        const DrawList list = Stage(rack_to_redraw(), options).at(0.5);
        Image expected, got;
        fresh.draw(list);
        fresh.read(expected);
        renderer.draw(list);
        renderer.read(got);
        EXPECT_TRUE(got.rgbx == expected.rgbx) << size.width;
    }
}

TEST(RedrawKept, ImagesReadInAnyOrderShowTheirFrame) {
    const Stage stage = stage_of("top");
    Renderer renderer, reference;
    std::array<KeptImage, 3> images;
    int k = 0;
    for (const double t : instants()) {
        const DrawList list = stage.at(t);
        renderer.draw(list);
        // Into an image that shows an earlier frame.
        KeptImage& image = images[static_cast<std::size_t>(k * k) % 3];
        renderer.read(image);
        EXPECT_TRUE(render_test::same_pixels(image.image(), whole_picture(reference, list))) << t;
        ++k;
    }
}

TEST(RedrawKept, AnImageMayMoveToAnotherRenderer) {
    const Stage stage = stage_of("top");
    Renderer first, second;
    KeptImage image;
    Image expected;
    for (const double t : {0.1, 0.3, 0.9}) {
        first.draw(stage.at(t));
        first.read(image);
        second.draw(stage.at(t + 0.1));
        second.read(image);
        second.read(expected);
        EXPECT_TRUE(render_test::same_pixels(image.image(), expected)) << t;
    }
}

// A frame costs nothing if nothing moves, and otherwise only the moving balls.
TEST(RedrawWork, OnlyMovedBallsAreDrawn) {
    const Stage stage = stage_of("top");
    const ClothMap none;
    const FrameSize size{480, 270};
    const auto table = std::make_shared<TableDrawing>();
    const auto picture = [&](double t) { return DrawnPicture{table, visible_balls(stage.at(t), none)}; };
    const double end = rack_to_redraw().duration;
    EXPECT_TRUE(differing_boxes(picture(end), picture(end + 1.0), size).empty());
    const DrawnPicture rack = picture(0.0), cue_moved = picture(0.01);
    std::vector<PixelBox> boxes = differing_boxes(rack, cue_moved, size);
    ASSERT_EQ(boxes.size(), 2U);  // the cue ball's old and new places
    const std::vector<bool> moved = inside(cue_moved, boxes, size).balls;
    EXPECT_EQ(std::count(moved.begin(), moved.end(), true), 1);
    // Touching one ball of a rack redraws the whole rack.
    boxes = {rack.balls[5].box};
    const std::vector<bool> all = inside(rack, boxes, size).balls;
    EXPECT_EQ(std::count(all.begin(), all.end(), true), 15);
    DrawnPicture other = rack;
    other.table = std::make_shared<TableDrawing>();
    EXPECT_EQ(differing_boxes(rack, other, size), (std::vector<PixelBox>{{0, 0, 480, 270}}));
}

double pixels_of(const std::vector<PixelBox>& boxes) {
    double sum = 0.0;
    for (const PixelBox& box : boxes) sum += double(box.x1 - box.x0) * (box.y1 - box.y0);
    return sum;
}

DrawnPicture picture_of(const DrawList& list, const std::shared_ptr<const TableDrawing>& table) {
    return {table, visible_balls(list, ClothMap()), drawn_shapes(list)};
}

// An overlay redraws only its changes: a clock's digits and everything they touch, which is its panel.
TEST(RedrawWork, AnOverlayIsDrawnWhereItChanges) {
    const Stage stage = stage_of("top", "clock");
    const FrameSize size{480, 270};
    const auto table = std::make_shared<TableDrawing>();
    const double end = rack_to_redraw().duration;
    const DrawnPicture before = picture_of(stage.at(end), table),
                       after = picture_of(stage.at(end + 0.1), table);
    std::vector<PixelBox> boxes = differing_boxes(before, after, size);
    EXPECT_GT(pixels_of(boxes), 0.0);
    EXPECT_LT(pixels_of(boxes), 0.01 * 480 * 270);
    const Inside drawn = inside(after, boxes, size);
    EXPECT_EQ(std::count(drawn.shapes.begin(), drawn.shapes.end(), true),
              static_cast<std::ptrdiff_t>(after.shapes.size()));
    EXPECT_EQ(std::count(drawn.balls.begin(), drawn.balls.end(), true), 0);
    EXPECT_TRUE(differing_boxes(after, after, size).empty());
}

// Overlapping shapes drawn in another order may look different.
TEST(RedrawWork, TheOrderOfShapesMatters) {
    DrawList list = stage_of("top").at(0.0);
    list.boxes = {{{10.0, 10.0}, {30.0, 30.0}, {1.0F, 0.0F, 0.0F, 1.0F}, -1},
                  {{20.0, 20.0}, {40.0, 40.0}, {0.0F, 1.0F, 0.0F, 1.0F}, -1}};
    const auto table = std::make_shared<TableDrawing>();
    const DrawnPicture before = picture_of(list, table);
    std::swap(list.boxes[0], list.boxes[1]);
    EXPECT_FALSE(differing_boxes(before, picture_of(list, table), {480, 270}).empty());
}

TEST(RedrawWork, BallsOnBareClothAreRecognised) {
    const Stage stage = stage_of("top");
    const DrawList list = stage.at(0.0);
    // Alpha marks cloth pixels: all here, then all but one in the corner of a ball's box.
    std::vector<std::uint8_t> alpha(std::size_t{4} * 480 * 270, 255);
    std::vector<DrawnBall> balls = visible_balls(list, ClothMap(alpha, {480, 270}));
    EXPECT_EQ(std::count_if(balls.begin(), balls.end(), [](const DrawnBall& b) { return b.plain; }), 16);
    const auto at =
        static_cast<std::size_t>(balls[7].box.y0) * 480 + static_cast<std::size_t>(balls[7].box.x0);
    alpha[4 * at + 3] = 254;
    balls = visible_balls(list, ClothMap(alpha, {480, 270}));
    EXPECT_FALSE(balls[7].plain);
    EXPECT_GE(std::count_if(balls.begin(), balls.end(), [](const DrawnBall& b) { return b.plain; }), 1);
    EXPECT_EQ(visible_balls(list, ClothMap{})[0].plain, false);
}

}  // namespace
}  // namespace carom::render
