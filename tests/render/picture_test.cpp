// Statistics of the pixels of pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "carom/render/renderer.h"
#include "render/hand_made.h"

namespace carom::render {
namespace {

using render_test::add_ball;
using render_test::kR;

DrawList list_of(const Record& record, FrameSize size, double t = 0.0) {
    StageOptions options;
    options.size = size;
    options.table_samples = 4;
    return Stage(record, options).at(t);
}

Image draw(const Record& record, FrameSize size, double t = 0.0, Backend backend = Backend::kOsmesa) {
    Renderer renderer(backend);
    renderer.draw(list_of(record, size, t));
    Image image;
    renderer.read(image);
    return image;
}

struct Color {
    int r, g, b;
};

Color at(const Image& image, double x, double y) {
    const std::uint8_t* p = image.pixel(static_cast<int>(x), static_cast<int>(y));
    return {p[0], p[1], p[2]};
}

bool is_green(Color c) {
    return c.g > c.r + 30 && c.g > c.b + 10 && c.g > 60;
}

// How much of a pixel a white ball covers: its difference from the cloth towards white.
double whiteness(const Image& image, int x, int y) {
    return image.pixel(x, y)[0] / 255.0;
}

TEST(Picture, ClothIsInTheMiddleWoodAroundItAndTheRoomOutside) {
    Record record = render_test::rectangle_record();
    add_ball(record, "cue", 0.2, 0.3);
    const Image image = draw(record, {640, 360});
    EXPECT_TRUE(is_green(at(image, 320, 180)));
    const Camera camera = list_of(record, {640, 360}).camera;
    const Vec2 rail = *camera.project({-0.09, 1.3, 0.045});
    const Color wood = at(image, rail.x(), rail.y());
    EXPECT_GT(wood.r, wood.g);
    EXPECT_GT(wood.g, wood.b);
    const Color corner = at(image, 1, 1);
    EXPECT_LT(corner.r + corner.g + corner.b, 120);
}

TEST(Picture, TheClothHasTheColourOfTheGameOrOfTheScene) {
    const auto middle = [](const std::string& preset, std::optional<std::string> cloth = {}) {
        Record record;
        record.table = make_table(preset);
        record.duration = 1.0;
        record.render.cloth = std::move(cloth);
        add_ball(record, "cue", 0.2, 0.3);
        return at(draw(record, {320, 180}), 150, 80);
    };
    EXPECT_TRUE(is_green(middle("nine_foot")));
    EXPECT_TRUE(is_green(middle("snooker")));
    const Color carom = middle("carom"), red = middle("nine_foot", "#a01008");
    EXPECT_GT(carom.b, carom.g + 40);
    EXPECT_GT(carom.b, carom.r + 80);
    EXPECT_GT(red.r, 120);
    EXPECT_LT(red.g + red.b, 60);
}

TEST(Picture, TheLongSideIsAlongTheImagesWideSide) {
    Record record = render_test::rectangle_record(1.0, 2.0);
    add_ball(record, "cue", 0.5, 0.2);
    for (FrameSize size : {FrameSize{640, 360}, FrameSize{360, 640}, FrameSize{400, 400}}) {
        const Camera camera = list_of(record, size).camera;
        const Vec2 a = *camera.project({0.5, 0.0, 0.0}), b = *camera.project({0.5, 2.0, 0.0});
        const Vec2 along = (b - a).cwiseAbs();
        if (size.width > size.height) {
            EXPECT_GT(along.x(), 100.0 * along.y());
        } else if (size.width < size.height) {
            EXPECT_GT(along.y(), 100.0 * along.x());
        }
        // The whole table is inside and fills one direction.
        for (double x : {-0.145, 1.145}) {
            for (double y : {-0.145, 2.145}) {
                const Vec2 corner = *camera.project({x, y, 0.04});
                EXPECT_GT(corner.minCoeff(), 0.0);
                EXPECT_LT(corner.x(), size.width);
                EXPECT_LT(corner.y(), size.height);
            }
        }
        EXPECT_GT(along.maxCoeff() * 2.29 / 2.0, 0.93 * (size.width == size.height ? 400 : 640));
    }
}

// World Snooker's measures: baulk line 29 in from the bottom cushion, a D of 11 1/2 in, black 12 3/4 in from
// the top cushion.
TEST(Picture, ASnookerTableHasItsLinesAndSpots) {
    Record record;
    record.table = make_table("snooker");
    record.duration = 1.0;
    add_ball(record, "cue", 0.3, 2.0);
    const FrameSize size{1920, 1080};
    const Image image = draw(record, size);
    const Camera camera = list_of(record, size).camera;
    const double w = record.table.width, l = record.table.length;
    const auto redness = [&](double x, double y) {
        const Vec2 pixel = *camera.project({x, y, 0.0});
        return at(image, pixel.x(), pixel.y()).r;
    };
    const Vec2 marks[] = {
        {0.3, 0.737},       {w - 0.3, 0.737},    {0.5 * w, 0.737 - 0.292}, {0.5 * w - 0.292, 0.737},
        {0.5 * w, 0.5 * l}, {0.5 * w, 0.75 * l}, {0.5 * w, l - 0.324}};
    for (const Vec2& mark : marks) {
        const int beside = redness(mark.x() + 0.05, mark.y() + 0.05);
        EXPECT_GT(redness(mark.x(), mark.y()), beside + 20) << mark.transpose();
    }
    // No D on the other side of the line.
    EXPECT_NEAR(redness(0.5 * w, 0.737 + 0.292), redness(0.5 * w + 0.05, 0.737 + 0.292 + 0.05), 8);
}

// The centre of a white ball, weighted by whiteness, against the camera's projection.
TEST(Picture, ABallIsAtItsProjectedPixel) {
    for (FrameSize size : {FrameSize{640, 360}, FrameSize{1280, 720}, FrameSize{450, 800}}) {
        for (const Vec2& place : {Vec2(0.5, 1.0), Vec2(0.1234, 0.3), Vec2(0.91, 1.877)}) {
            Record with = render_test::rectangle_record(), without = with;
            add_ball(with, "cue", place.x(), place.y());
            add_ball(without, "cue", place.x() < 0.5 ? place.x() + 0.3 : place.x() - 0.3, place.y());
            const Camera camera = list_of(with, size).camera;
            const Vec2 expected = *camera.project({place.x(), place.y(), kR});
            const double radius = kR * camera.scale({place.x(), place.y(), kR});
            const Image image = draw(with, size), empty = draw(without, size);
            double weight = 0.0;
            Vec2 sum(0.0, 0.0);
            const int reach = static_cast<int>(radius) + 3;
            for (int y = static_cast<int>(expected.y()) - reach; y <= static_cast<int>(expected.y()) + reach;
                 ++y) {
                for (int x = static_cast<int>(expected.x()) - reach;
                     x <= static_cast<int>(expected.x()) + reach; ++x) {
                    // Red distinguishes ball from cloth, as shadows only darken. Half of the ball's red
                    // saturates at its middle.
                    const double w =
                        std::clamp((whiteness(image, x, y) - whiteness(empty, x, y)) / 0.3, 0.0, 1.0);
                    weight += w;
                    sum += w * Vec2(x + 0.5, y + 0.5);
                }
            }
            ASSERT_GT(weight, 0.7 * 3.14 * radius * radius) << size.width << " " << place.transpose();
            EXPECT_LT((sum / weight - expected).norm(), 0.5) << size.width << " " << place.transpose();
        }
    }
}

TEST(Picture, EdgesAreSmooth) {
    Record record = render_test::rectangle_record();
    add_ball(record, "cue", 0.5, 1.0);
    const FrameSize size{1280, 720};
    const Image image = draw(record, size);
    const Camera camera = list_of(record, size).camera;
    const Vec2 center = *camera.project({0.5, 1.0, kR});
    const double radius = kR * camera.scale({0.5, 1.0, kR});
    // Along the rim, pixels between cloth and ball have many values, not two.
    std::set<int> values;
    int between = 0;
    for (int i = 0; i < 360; ++i) {
        const double angle = i * 3.14159265358979 / 180.0;
        const int red =
            at(image, center.x() + radius * std::cos(angle), center.y() + radius * std::sin(angle)).r;
        values.insert(red);
        if (red > 40 && red < 150) ++between;
    }
    EXPECT_GT(values.size(), 10U);
    EXPECT_GT(between, 60);
}

Record spinning(const std::string& id, const Vec3& spin) {
    Record record = render_test::rectangle_record();
    Segment segment = render_test::still({0.5, 1.0, kR});
    segment.w = spin;
    segment.state = MotionState::kSliding;
    add_ball(record, id, segment);
    return record;
}

TEST(Picture, ABallThatTurnsChangesItsPixels) {
    for (const char* id : {"cue", "3", "12", "red", "thing"}) {
        const Record record = spinning(id, {3.0, 2.0, 1.0});
        const Image before = draw(record, {640, 360}, 0.0), after = draw(record, {640, 360}, 0.4);
        int changed = 0;
        for (std::size_t i = 0; i < before.rgbx.size(); ++i) {
            if (std::abs(before.rgbx[i] - after.rgbx[i]) > 25) ++changed;
        }
        EXPECT_GT(changed, 30) << id;
    }
}

TEST(Picture, AFullTurnRestoresThePixels) {
    const double pi = 3.14159265358979323846;
    const Record record = spinning("12", {0.0, 0.0, 2.0 * pi});
    const Image start = draw(record, {320, 180}, 0.0), quarter = draw(record, {320, 180}, 0.25);
    const Image full = draw(record, {320, 180}, 1.0);
    int worst = 0, moved = 0;
    for (std::size_t i = 0; i < start.rgbx.size(); ++i) {
        worst = std::max(worst, std::abs(start.rgbx[i] - full.rgbx[i]));
        moved = std::max(moved, std::abs(start.rgbx[i] - quarter.rgbx[i]));
    }
    EXPECT_LE(worst, 2);
    EXPECT_GT(moved, 60);
}

// A turn about +x (right-hand rule) moves the top towards -y, which is left in a horizontal image.
TEST(Picture, BallsTurnInTheRightDirection) {
    const Record record = spinning("8", {1.0, 0.0, 0.0});
    const FrameSize size{1600, 900};
    const Camera camera = list_of(record, size).camera;
    const Vec2 center = *camera.project({0.5, 1.0, kR});
    const double radius = kR * camera.scale({0.5, 1.0, kR});
    const auto spot = [&](double t) {
        const Image image = draw(record, size, t);
        double weight = 0.0;
        Vec2 sum(0.0, 0.0);
        for (int y = -20; y <= 20; ++y) {
            for (int x = -20; x <= 20; ++x) {
                const double w =
                    at(image, center.x() + x, center.y() + y).r > 110 && std::hypot(x, y) < 0.95 * radius;
                weight += w;
                sum += w * Vec2(x, y);
            }
        }
        return Vec2(sum / weight);
    };
    const Vec2 move = spot(0.6) - spot(0.0);
    EXPECT_LT(move.x(), -0.3 * radius);
    EXPECT_LT(std::abs(move.y()), 0.15 * radius);
}

TEST(Picture, BallsCastSoftShadowsOnTheClothOnly) {
    Record with = render_test::rectangle_record(), without = with;
    // The lamp is over the middle: beside it, the shadow lies on the far side.
    add_ball(with, "cue", 0.8, 1.0);
    add_ball(without, "cue", 0.5, 0.4);
    const FrameSize size{1280, 720};
    const Image shaded = draw(with, size), plain = draw(without, size);
    const Camera camera = list_of(with, size).camera;
    const auto green = [&](const Image& image, double away) {
        const Vec2 p = *camera.project({0.8 + away * kR, 1.0, 0.0});
        return at(image, p.x(), p.y()).g;
    };
    EXPECT_LT(green(shaded, 1.25), 0.8 * green(plain, 1.25));
    EXPECT_LT(green(shaded, 1.25), green(shaded, 1.5) - 10) << "soft";
    EXPECT_LT(green(shaded, 1.5), green(plain, 1.5));
    EXPECT_GT(green(shaded, -1.25), green(shaded, 1.25) + 15);
    EXPECT_LT(green(shaded, -1.25), green(plain, -1.25)) << "some of the room is hidden there";
    EXPECT_EQ(green(shaded, 4.0), green(plain, 4.0));
}

// The lamp's reflection covers one half of an 8, whose strokes must be as dark there as in the other half.
TEST(Picture, NumbersAreLegibleUnderTheLamp) {
    Record record = render_test::rectangle_record();
    add_ball(record, "8", 0.5, 1.7);
    const FrameSize size{2560, 1440};
    const Image image = draw(record, size);
    const Camera camera = list_of(record, size).camera;
    const Vec2 center = *camera.project({0.5, 1.7, 2.0 * kR});
    const double radius = kR * camera.scale({0.5, 1.7, kR});
    std::array<int, 2> ink{};
    // The lamp is long and narrow; its reflection is at half the height of the number.
    for (int y = static_cast<int>(-0.15 * radius); y <= 0.15 * radius; ++y) {
        for (int x = static_cast<int>(-0.4 * radius); x <= 0.4 * radius; ++x)
            ink[x < 0 ? 0 : 1] += at(image, center.x() + x, center.y() + y).r < 90;
    }
    EXPECT_GT(ink[0], 20);
    EXPECT_GT(ink[0], 0.7 * ink[1]);
    EXPECT_LT(ink[0], 1.4 * ink[1]);
}

TEST(Picture, ABallDarkensTheCushionAndTheBallBesideIt) {
    const FrameSize size{1280, 720};
    Record with = render_test::rectangle_record(), without = with;
    add_ball(with, "red", kR + 0.001, 1.0);
    add_ball(without, "red", kR + 0.001, 0.5);
    add_ball(with, "white", 0.5, 1.0);
    add_ball(without, "white", 0.5, 1.0);
    add_ball(with, "yellow", 0.5, 1.0 + 2.0 * kR);
    add_ball(without, "yellow", 0.5, 1.5);
    const Image shaded = draw(with, size), plain = draw(without, size);
    const Camera camera = list_of(with, size).camera;
    const Vec2 nose = *camera.project({-0.01, 1.0, 0.04});
    EXPECT_LT(at(shaded, nose.x(), nose.y()).g, 0.9 * at(plain, nose.x(), nose.y()).g);
    const Vec2 touching = *camera.project({0.5, 1.0 + 0.9 * kR, 1.4 * kR});
    EXPECT_LT(at(shaded, touching.x(), touching.y()).r, 0.85 * at(plain, touching.x(), touching.y()).r);
}

TEST(Picture, TheSameListGivesTheSamePixels) {
    Record record = render_test::rectangle_record();
    add_ball(record, "1", 0.5, 1.0);
    Renderer renderer;
    Image first, second;
    const DrawList list = list_of(record, {320, 180});
    renderer.draw(list);
    renderer.read(first);
    renderer.draw(list);
    renderer.read(second);
    EXPECT_TRUE(render_test::same_pixels(first, second));
    EXPECT_TRUE(render_test::same_pixels(first, [&] {
        Renderer other;
        Image image;
        other.draw(list);
        other.read(image);
        return image;
    }()));
}

// The largest green difference between neighbours, in a picture straight down at the cloth.
int contrast_of_cloth(double pixel) {
    constexpr FrameSize kSize{480, 270};
    DrawList list = list_of(render_test::rectangle_record(), kSize);
    const double height = 0.5 * pixel * kSize.height / std::tan(20.0 * std::numbers::pi / 180.0);
    list.camera = Camera();
    list.camera.eye = Vec3(0.5, 1.0, height);
    list.camera.target = Vec3(0.5, 1.0001, 0.0);
    list.camera.size = kSize;
    EXPECT_NEAR(1.0 / list.camera.scale({0.5, 1.0, 0.0}), pixel, 0.02 * pixel);
    Renderer renderer(Backend::kOsmesa);
    Image image;
    renderer.draw(list);
    renderer.read(image);
    int most = 0;
    for (int y = 1; y < kSize.height; ++y) {
        for (int x = 1; x < kSize.width; ++x)
            most = std::max(most, std::abs(image.pixel(x, y)[1] - image.pixel(x - 1, y)[1]));
    }
    return most;
}

// A thread is 1.3 mm wide; at 2160p the whole table has pixels of 0.75 mm.
TEST(Picture, TheWeaveShowsOnlyIfAThreadIsWiderThanTwoPixels) {
    EXPECT_LE(contrast_of_cloth(0.75e-3), 1);
    EXPECT_LE(contrast_of_cloth(0.65e-3), 1);
    EXPECT_GE(contrast_of_cloth(0.25e-3), 6);
}

TEST(Picture, LargerPicturesHaveTheSameTotalOfTableSamples) {
    const Record record = render_test::rectangle_record();
    const auto samples = [&](FrameSize size, int wanted) {
        StageOptions options;
        options.size = size;
        options.table_samples = wanted;
        return Stage(record, options).at(0.0).table_samples;
    };
    EXPECT_EQ(samples({640, 360}, 16), 16);
    EXPECT_EQ(samples({1920, 1080}, 16), 16);
    EXPECT_EQ(samples({2560, 1440}, 16), 9);
    EXPECT_EQ(samples({3840, 2160}, 16), 4);
    EXPECT_EQ(samples({7680, 4320}, 16), 4) << "edges need some";
    EXPECT_EQ(samples({3840, 2160}, 2), 2);
}

}  // namespace
}  // namespace carom::render
