// Six pictures kept in the repository. Another version of Mesa may round a pixel differently, so small
// differences pass. On failure the picture and the difference (times eight) are kept in the working
// directory.
//
// CAROM_UPDATE_GOLDEN=1 rewrites the pictures and skips the comparison: look at them before committing them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ostream>
#include <string>
#include <vector>

#include "carom/engine/scene.h"
#include "carom/render/error.h"
#include "carom/render/png.h"
#include "carom/render/renderer.h"
#include "render/hand_made.h"
#include "support/read_png.h"

namespace carom::render {
namespace {

using render_test::add_ball;
using render_test::kR;

struct Picture {
    Record record;
    StageOptions options;
    double time = 0.0;
};

Segment moving(const Vec3& place, const Vec2& velocity, const Vec3& spin, MotionState state) {
    Segment segment = render_test::still(place);
    segment.v = Vec3(velocity.x(), velocity.y(), 0.0);
    segment.w = spin;
    segment.state = state;
    return segment;
}

// Fifteen balls in a rack's places, in the order of their numbers.
void add_rack(Record& record) {
    const Vec2 foot = foot_spot(record.table);
    int number = 0;
    for (int row = 0; row < 5; ++row) {
        for (int i = 0; i <= row; ++i) {
            add_ball(record, std::to_string(++number), foot.x() + (2.0 * i - row) * kR,
                     foot.y() + row * 1.7321 * kR);
        }
    }
}

Record preset_record(const std::string& preset) {
    Record record;
    record.table = make_table(preset);
    record.balls.R = preset == "carom" ? 0.03075 : kR;
    record.duration = 2.0;
    return record;
}

Picture nine_foot_rack() {
    Picture picture{preset_record("nine_foot"), {}};
    add_rack(picture.record);
    add_ball(picture.record, "cue", 0.635, 0.5);
    return picture;
}

Picture seven_foot_rail() {
    Picture picture{preset_record("seven_foot"), {}};
    add_rack(picture.record);
    add_ball(picture.record, "cue",
             moving({0.3, 0.3, kR}, {0.4, 0.5}, {-0.5 / kR, 0.4 / kR, 12.0}, MotionState::kRolling));
    Segment gone = render_test::still(
        {picture.record.table.pockets[0].center.x(), picture.record.table.pockets[0].center.y(), -0.08});
    gone.state = MotionState::kPocketed;
    picture.record.tracks[2].segments.assign(1, gone);
    picture.record.tracks[2].pocket = 0;
    picture.options.camera = "rail";
    picture.time = 0.7;
    return picture;
}

Picture carom_player() {
    Picture picture{preset_record("carom"), {}};
    const double R = picture.record.balls.R;
    add_ball(picture.record, "white",
             moving({0.5, 0.6, R}, {0.3, 0.9}, {-0.9 / R, 0.3 / R, 0.0}, MotionState::kRolling));
    add_ball(picture.record, "yellow", render_test::still({0.9, 1.2, R}));
    add_ball(picture.record, "red", render_test::still({0.71, 2.13, R}));
    picture.options.camera = "player";
    picture.time = 0.5;
    return picture;
}

Picture upright_overlay() {
    Picture picture{preset_record("seven_foot"), {}};
    Segment curve = moving({0.2, 0.4, kR}, {0.2, 1.6}, {20.0, 5.0, -30.0}, MotionState::kSliding);
    curve.a = Vec2(0.6, -0.4);
    add_ball(picture.record, "cue", curve);
    add_ball(picture.record, "8", 0.6, 1.5);
    add_ball(picture.record, "13", 0.4, 0.9);
    picture.record.events = {{0.0, EventType::kCueStrike, 0, -1},
                             {0.4, EventType::kBallBall, 0, 2},
                             {1.2, EventType::kBallBall, 0, 1}};
    picture.options.size = {180, 320};
    picture.options.overlay = parse_overlay("all");
    picture.time = 0.6;
    return picture;
}

Picture endless_cloth() {
    Picture picture{Record(), {}};
    picture.record.balls.R = kR;
    picture.record.duration = 1.0;
    add_ball(picture.record, "a",
             moving({0.0, 0.0, kR}, {0.5, 0.0}, {0.0, 0.5 / kR, 0.0}, MotionState::kRolling));
    add_ball(picture.record, "blue", 0.25, 0.2);
    add_ball(picture.record, "9", 0.1, 0.1);
    return picture;
}

// An L of six cushions, a post, an open wall inside and a pocket in the cloth.
Picture own_outline() {
    Picture picture{render_test::rectangle_record(), {}};
    Table& table = picture.record.table;
    table = Table{};
    const std::vector<Vec2> corners{{0, 0}, {1.2, 0}, {1.2, 0.5}, {0.5, 0.5}, {0.5, 1.2}, {0, 1.2}};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        table.cushions.push_back(
            {"c" + std::to_string(i), corners[i], corners[(i + 1) % corners.size()], 1.28 * kR});
    }
    table.cushions.push_back({"wall", {0.75, 0.2}, {0.95, 0.32}, 1.28 * kR});
    table.jaws.push_back({"post", {0.25, 0.8}, 0.05, 1.28 * kR});
    table.pockets.push_back({"hole", {0.2, 0.2}, 0.06, 0.08});
    add_ball(picture.record, "cue", 1.0, 0.15);
    add_ball(picture.record, "3", 0.7, 0.35);
    add_ball(picture.record, "12", 0.35, 1.0);
    return picture;
}

Image draw(const Picture& picture, Backend backend) {
    StageOptions options = picture.options;
    if (options.size == FrameSize{}) options.size = {320, 180};
    Renderer renderer(backend);
    renderer.draw(Stage(picture.record, options).at(picture.time, FrameBudget{5.0, 16.7}));
    Image image;
    renderer.read(image);
    for (std::size_t i = 3; i < image.rgbx.size(); i += 4) image.rgbx[i] = 0xFF;
    return image;
}

void save(const Image& image, const std::string& path) {
    std::vector<std::uint8_t> bytes;
    encode_png(image, 9, bytes);
    write_file(path, bytes);
}

void compare(const Image& image, const std::string& name) {
    const std::string path = std::string(CAROM_SOURCE_DIR) + "/tests/render/golden/" + name + ".png";
    if (std::getenv("CAROM_UPDATE_GOLDEN") != nullptr) {
        save(image, path);
        GTEST_SKIP() << "renewed " << path << ", and nothing compared; run again without CAROM_UPDATE_GOLDEN";
    }
    const Image golden = render_test::read_png(path);
    ASSERT_EQ(golden.size, image.size);
    Image difference = image;
    double sum = 0.0;
    int far = 0;
    for (std::size_t i = 0; i < image.rgbx.size(); ++i) {
        if (i % 4 == 3) continue;
        const int apart = std::abs(image.rgbx[i] - golden.rgbx[i]);
        sum += apart;
        if (apart > 24) ++far;
        difference.rgbx[i] = static_cast<std::uint8_t>(std::min(255, 8 * apart));
    }
    const double channels = 0.75 * static_cast<double>(image.rgbx.size());
    EXPECT_LT(sum / channels, 0.5) << name << ": mean difference of 255";
    EXPECT_LT(far, 2e-4 * channels) << name << ": channels that differ by more than 24";
    if (testing::Test::HasFailure()) {
        save(image, "golden_" + name + "_is.png");
        save(difference, "golden_" + name + "_difference.png");
        std::printf("kept golden_%s_is.png and golden_%s_difference.png\n", name.c_str(), name.c_str());
    }
}

using MakePicture = Picture (*)();
struct Case {
    const char* name;
    MakePicture make;
};

// Google Test would print the bytes of the pointers, which differ between runs.
void PrintTo(const Case& each, std::ostream* out) {
    *out << each.name;
}

class Golden : public testing::TestWithParam<Case> {};

TEST_P(Golden, LooksAsItDid) {
    compare(draw(GetParam().make(), Backend::kOsmesa), GetParam().name);
}

TEST_P(Golden, OsmesaAndEglGiveTheSamePixels) {
    const Picture picture = GetParam().make();
    const Image osmesa = draw(picture, Backend::kOsmesa);
    Image egl;
    try {
        egl = draw(picture, Backend::kEgl);
    } catch (const RenderError& error) {
        // Only OSMesa is required; the message must name a missing one.
        EXPECT_NE(std::string(error.what()).find("libegl"), std::string::npos) << error.what();
        GTEST_SKIP() << error.what();
    }
    EXPECT_TRUE(render_test::same_pixels(osmesa, egl));
}

TEST(GoldenCompare, DetectsABallMovedByTwoPixels) {
    Picture picture = nine_foot_rack();
    const Image before = draw(picture, Backend::kOsmesa);
    picture.record.tracks.back().segments[0].r.y() += 0.02;
    const Image after = draw(picture, Backend::kOsmesa);
    int far = 0;
    for (std::size_t i = 0; i < before.rgbx.size(); ++i) far += std::abs(before.rgbx[i] - after.rgbx[i]) > 24;
    EXPECT_GT(far, 20);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Golden,
    testing::Values(Case{"nine_foot_rack", nine_foot_rack}, Case{"seven_foot_rail", seven_foot_rail},
                    Case{"carom_player", carom_player}, Case{"upright_overlay", upright_overlay},
                    Case{"endless_cloth", endless_cloth}, Case{"own_outline", own_outline}),
    [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace carom::render
