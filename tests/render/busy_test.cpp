// The table is drawn with many samples only where they show.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "carom/render/renderer.h"
#include "draw/mean_picture.h"
#include "draw/table_edges.h"
#include "render/hand_made.h"

namespace carom::render {
namespace {

constexpr FrameSize kSmallFrame{67, 41};  // not a multiple of a tile

std::vector<std::uint8_t> grey_picture() {
    return std::vector<std::uint8_t>(std::size_t{4} * 67 * 41, 90);
}

bool holds(const std::vector<PixelBox>& boxes, int x, int y) {
    return std::any_of(boxes.begin(), boxes.end(), [&](const PixelBox& box) {
        return box.meets({x, y, x + 1, y + 1});
    });
}

View view_from_above(const TableMesh& mesh) {
    Camera camera;
    camera.eye = Vec3(0.0, 0.0, 3.0);
    camera.size = kSmallFrame;
    return make_view(camera, mesh);
}

TEST(BusyTiles, AnEvenPictureHasNoBusyTiles) {
    EXPECT_TRUE(busy_tiles(grey_picture(), kSmallFrame, TableMesh{}, view_from_above({})).empty());
}

TEST(BusyTiles, ContrastIsBusyOnBothSides) {
    for (const int levels : {3, 4}) {
        std::vector<std::uint8_t> rgba = grey_picture();
        for (int y = 16; y < 41; ++y) {
            for (int x = 0; x < 67; ++x)
                rgba[std::size_t{4} * (static_cast<std::size_t>(y) * 67 + static_cast<std::size_t>(x)) + 1] +=
                    static_cast<std::uint8_t>(levels);
        }
        const std::vector<PixelBox> boxes = busy_tiles(rgba, kSmallFrame, TableMesh{}, view_from_above({}));
        for (const int x : {0, 33, 66}) {
            EXPECT_EQ(holds(boxes, x, 15), levels == 4);
            EXPECT_EQ(holds(boxes, x, 16), levels == 4);
            EXPECT_FALSE(holds(boxes, x, 7));
            EXPECT_FALSE(holds(boxes, x, 24));
        }
    }
}

// A strip too thin for any sample to hit.
TEST(BusyTiles, EdgesAreBusyEvenIfNoSampleHitsThem) {
    TableMesh mesh;
    const auto corner = [](float x, float y) {
        return MeshVertex{x, y, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, static_cast<float>(Material::kWood)};
    };
    mesh.solid = {corner(-0.5F, 0.1F), corner(0.5F, 0.1F), corner(0.5F, 0.1001F)};
    Camera camera;
    camera.eye = Vec3(0.0, 0.0, 3.0);
    camera.size = kSmallFrame;
    const std::vector<PixelBox> boxes =
        busy_tiles(grey_picture(), kSmallFrame, mesh, make_view(camera, mesh));
    for (const double x : {-0.5, -0.2, 0.1, 0.49}) {
        const Vec2 at = *camera.project({x, 0.1, 0.0});
        EXPECT_TRUE(holds(boxes, static_cast<int>(at.x()), static_cast<int>(at.y()))) << x;
    }
    const Vec2 far = *camera.project({0.0, -0.3, 0.0});
    EXPECT_FALSE(holds(boxes, static_cast<int>(far.x()), static_cast<int>(far.y())));
}

TEST(MeanPicture, IsComputedInLinearLightWithinItsBoxes) {
    std::vector<std::uint8_t> first(16, 0);
    MeanPicture mean(first, 2, {{0, 0, 1, 2}});  // the left column of two by two pixels
    mean.add({200, 0, 0, 255, 200, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0, 0});
    mean.add({200, 0, 0, 255, 200, 0, 0, 255, 0, 90, 0, 0, 0, 0, 0, 0});
    mean.finish();
    const auto& linear = radiance_of_screen();
    EXPECT_EQ(first[0], screen_of_radiance(linear[200] * 2.0F / 3.0F));
    EXPECT_GT(first[0], 133) << "the mean of the bytes would be darker";
    EXPECT_EQ(first[3], 170);
    EXPECT_EQ(first[4], 0) << "outside the boxes";
    EXPECT_EQ(first[9], screen_of_radiance(linear[90] / 3.0F));
    EXPECT_EQ(first[8], 0);
}

TEST(MeanPicture, ScreenValuesSurviveTheRoundTrip) {
    const auto& linear = radiance_of_screen();
    for (int i = 0; i < 255; ++i) EXPECT_EQ(screen_of_radiance(linear[static_cast<std::size_t>(i)]), i);
}

// A picture with many samples equals one drawn four times as large with one sample and then reduced, except
// for grain and sample positions. With all pixels sampled often, or only the busy ones, 192 and 22 channels
// are far off; with none, 2342 and 979.
TEST(BusyTiles, ManySamplesLookLikeAReducedLargePicture) {
    const Record record = render_test::rectangle_record();
    for (const char* camera : {"top", "player"}) {
        StageOptions options;
        options.camera = camera;
        options.size = {320, 180};
        Renderer renderer;
        Image image, large;
        DrawList list = Stage(record, options).at(0.0);
        list.balls.clear();
        renderer.draw(list);
        renderer.read(image);
        list.table_samples = 1;
        list.camera.size = {1280, 720};
        renderer.draw(list);
        renderer.read(large);
        const auto& linear = radiance_of_screen();
        int far = 0;
        for (int y = 0; y < 180; ++y) {
            for (int x = 0; x < 320; ++x) {
                for (int k = 0; k < 3; ++k) {
                    float sum = 0.0F;
                    for (int i = 0; i < 16; ++i) sum += linear[large.pixel(4 * x + i % 4, 4 * y + i / 4)[k]];
                    far += std::abs(image.pixel(x, y)[k] - screen_of_radiance(sum / 16.0F)) > 16;
                }
            }
        }
        EXPECT_LT(far, 300) << camera;
    }
}

}  // namespace
}  // namespace carom::render
