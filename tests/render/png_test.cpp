// PNG files in which only changes are re-encoded: any decoder reads them, and their bytes depend only on the
// pixels.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/simulate.h"
#include "carom/render/error.h"
#include "carom/render/kept_png.h"
#include "carom/render/png.h"
#include "carom/render/renderer.h"
#include "frames/png_pieces.h"
#include "support/read_png.h"

namespace carom::render {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Random = std::mt19937;

int below(Random& random, int end) {
    return static_cast<int>(random() % static_cast<unsigned>(end));
}

PixelBox whole(FrameSize size) {
    return {0, 0, size.width, size.height};
}

// Fills a box as pictures typically do: one colour, a gradient, noise, few colours, long and short runs. The
// fourth channel is arbitrary.
void paint(Image& image, const PixelBox& box, Random& random) {
    const int way = below(random, 5);
    const auto byte = [&] { return static_cast<std::uint8_t>(random()); };
    const std::array<std::uint8_t, 6> colors{byte(), byte(), byte(), byte(), byte(), byte()};
    const unsigned change = 1U + random() % 30U;
    std::size_t which = 0;
    for (int y = box.y0; y < box.y1; ++y) {
        for (int x = box.x0; x < box.x1; ++x) {
            std::uint8_t* const pixel =
                image.rgbx.data() +
                4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.size.width) +
                     static_cast<std::size_t>(x));
            if (random() % change == 0) which = 3 - which;
            for (std::size_t c = 0; c < 3; ++c) {
                const auto slope = static_cast<std::uint8_t>(colors[c] + x * (way - 1) + y);
                pixel[c] = way == 0 ? colors[c] : way < 3 ? slope : way == 3 ? byte() : colors[which + c];
            }
            pixel[3] = byte();
        }
    }
}

PixelBox random_box(FrameSize size, Random& random) {
    const int x0 = below(random, size.width), y0 = below(random, size.height);
    return {x0, y0, x0 + 1 + below(random, std::min(100, size.width - x0)),
            y0 + 1 + below(random, std::min(20, size.height - y0))};
}

// The bytes of a file encoded in one go.
Bytes file_of(const Image& image) {
    Bytes bytes;
    KeptPng().encode(image, bytes);
    return bytes;
}

bool same_colors(const Image& a, const Image& b) {
    if (!(a.size == b.size)) return false;
    for (std::size_t i = 0; i < a.rgbx.size(); ++i)
        if (i % 4 != 3 && a.rgbx[i] != b.rgbx[i]) return false;
    return true;
}

std::uint32_t big(const Bytes& bytes, std::size_t at) {
    return std::uint32_t{bytes.at(at)} << 24U | std::uint32_t{bytes.at(at + 1)} << 16U |
           std::uint32_t{bytes.at(at + 2)} << 8U | bytes.at(at + 3);
}

// Checks what libpng may silently ignore: every chunk's checksum, and that of the zlib stream, which must end
// with the rows.
void expect_sound(const Bytes& bytes, FrameSize size) {
    std::string types;
    for (std::size_t at = 8; at < bytes.size();) {
        const std::size_t length = big(bytes, at);
        types.append(bytes.begin() + static_cast<std::ptrdiff_t>(at + 4),
                     bytes.begin() + static_cast<std::ptrdiff_t>(at + 8));
        ASSERT_EQ(big(bytes, at + 8 + length),
                  crc32(0, bytes.data() + at + 4, static_cast<uInt>(length + 4)));
        if (types == "IHDRIDAT") {
            Bytes rows(
                static_cast<std::size_t>(size.height) * (1 + 3 * static_cast<std::size_t>(size.width)) + 1);
            uLongf found = rows.size();
            uLong used = length;
            ASSERT_EQ(uncompress2(rows.data(), &found, bytes.data() + at + 8, &used), Z_OK);
            ASSERT_EQ(found, rows.size() - 1);
            ASSERT_EQ(used, length);
        }
        at += 12 + length;
    }
    ASSERT_EQ(types, "IHDRIDATIEND");
}

// Split into series that can run in parallel. Every picture is changed several times in boxes, and its file
// must equal the one encoded in one go.
class RandomPictures : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomPictures, ReadBackAndEqualOneGoFiles) {
    Random random(GetParam());
    constexpr int kPictures = 1250, kChanges = 10;
    for (int made = 0; made < kPictures; made += kChanges) {
        Image image;
        image.resize({1 + below(random, 300), 1 + below(random, 60)});
        paint(image, whole(image.size), random);
        PngPieces pieces;
        std::vector<PixelBox> boxes{whole(image.size)};
        for (int change = 0; change < kChanges; ++change) {
            Bytes bytes;
            pieces.encode(image, boxes, bytes);
            ASSERT_TRUE(same_colors(render_test::read_png(bytes), image))
                << made << " " << image.size.width << "x" << image.size.height;
            ASSERT_NO_FATAL_FAILURE(expect_sound(bytes, image.size));
            ASSERT_EQ(bytes, file_of(image)) << made << " " << change;
            ASSERT_GT(pieces.share(), 0.0);
            boxes.clear();
            for (int box = 0; box <= below(random, 4); ++box) {
                boxes.push_back(random_box(image.size, random));
                paint(image, boxes.back(), random);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Series, RandomPictures, ::testing::Values(1U, 2U, 3U, 4U));

TEST(PngPieces, EncodesNoMoreThanTheBoxesAndTheirNeighbours) {
    Random random(7);
    Image image;
    image.resize({640, 100});
    paint(image, whole(image.size), random);
    PngPieces pieces;
    Bytes bytes;
    pieces.encode(image, {whole(image.size)}, bytes);
    EXPECT_EQ(pieces.share(), 1.0);
    pieces.encode(image, {}, bytes);
    EXPECT_EQ(pieces.share(), 0.0);
    EXPECT_EQ(bytes, file_of(image));
    // Ten rows of one segment of ten, and the row below; two pixels before the end of the segment are far
    // enough from the next one.
    pieces.encode(image, {{64, 20, 126, 30}}, bytes);
    EXPECT_DOUBLE_EQ(pieces.share(), 11.0 / 1000.0);
    pieces.encode(image, {{64, 20, 127, 30}}, bytes);
    EXPECT_DOUBLE_EQ(pieces.share(), 22.0 / 1000.0);
    pieces.encode(image, {{0, 99, 1, 100}}, bytes);
    EXPECT_DOUBLE_EQ(pieces.share(), 1.0 / 1000.0);
}

TEST(PngPieces, NoiseIsAtMostHalfLargerThanItsPixels) {
    Random random(3);
    Image image;
    image.resize({256, 256});
    for (std::uint8_t& byte : image.rgbx) byte = static_cast<std::uint8_t>(random());
    EXPECT_LE(file_of(image).size(), 256U * (256U * 3U + 1U) * 3U / 2U + 300U);
}

TEST(PngPieces, AnImageWithoutPixelsIsRefused) {
    Bytes bytes;
    EXPECT_THROW(KeptPng().encode(Image{}, bytes), RenderError);
    EXPECT_THROW(KeptPng().encode(KeptImage{}, bytes), RenderError);
}

const Record& broken_rack() {
    static const Record record = [] {
        const Scene scene = read_scene(std::string(CAROM_SOURCE_DIR) + "/scenes/eight_ball_break.toml");
        return simulate(make_plan(scene, kernel::Isa::kScalar));
    }();
    return record;
}

struct View {
    const char *name, *camera, *overlay;
    FrameSize size;
};

Stage stage_of(const View& view) {
    StageOptions options;
    options.camera = view.camera;
    options.overlay = parse_overlay(view.overlay);
    options.size = view.size;
    options.table_samples = 4;
    return Stage(broken_rack(), options);
}

class Frames : public ::testing::TestWithParam<View> {};

// Successive frames, read alternately into two images, with jumps in time, as the encoders of several threads
// receive them.
TEST_P(Frames, AnEncoderThatKeepsPiecesWritesTheSameFiles) {
    const Stage stage = stage_of(GetParam());
    Renderer renderer;
    std::array<KeptImage, 2> images;
    KeptPng kept;
    std::size_t turn = 0;
    double least = 1.0;
    for (const double t : {0.0, 0.3, 0.31, 0.33, 0.9, 2.0, 2.02, 0.3, broken_rack().duration}) {
        KeptImage& image = images[turn++ % 2];
        renderer.draw(stage.at(t));
        renderer.read(image);
        Bytes bytes;
        kept.encode(image, bytes);
        EXPECT_EQ(bytes, file_of(image.image())) << t;
        EXPECT_TRUE(same_colors(render_test::read_png(bytes), image.image())) << t;
        least = std::min(least, kept.share());
    }
    const bool in_parts = std::string(GetParam().camera) != "follow" && GetParam().overlay[0] == '\0';
    EXPECT_LE(least, in_parts ? 0.3 : 1.0);
}

TEST_P(Frames, AreAtMostHalfLargerThanLibpngs) {
    const Stage stage = stage_of(GetParam());
    Renderer renderer;
    Image image;
    for (const double t : {0.0, 1.5}) {
        renderer.draw(stage.at(t));
        renderer.read(image);
        Bytes level_1;
        encode_png(image, 1, level_1);
        EXPECT_LE(file_of(image).size(), level_1.size() * 3 / 2) << t;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Views, Frames,
    ::testing::Values(View{"top", "top", "", {960, 540}}, View{"rail", "rail", "", {960, 540}},
                      View{"player", "player", "", {960, 540}}, View{"follow", "follow", "", {960, 540}},
                      View{"overlays", "top", "trails,events,spin,ghost,clock", {960, 540}},
                      View{"odd", "top", "", {481, 271}}),
    [](const auto& view) { return std::string(view.param.name); });

// A size that changes, then an image without known history, then back.
TEST(KeptPngTest, RestartsWithoutHistory) {
    const Stage large = stage_of({"", "top", "", {480, 270}}), small = stage_of({"", "top", "", {320, 180}});
    Renderer renderer;
    KeptImage image;
    KeptPng kept;
    Bytes bytes;
    int turn = 0;
    for (const Stage* stage : {&large, &large, &small, &large, &large}) {
        renderer.draw(stage->at(0.3 + 0.05 * turn));
        renderer.read(image);
        if (turn == 4) {
            Image other = image.image();
            std::fill(other.rgbx.begin(), other.rgbx.end(), std::uint8_t{9});
            kept.encode(other, bytes);
            EXPECT_EQ(bytes, file_of(other));
        }
        kept.encode(image, bytes);
        EXPECT_EQ(bytes, file_of(image.image())) << turn;
        ++turn;
    }
}

}  // namespace
}  // namespace carom::render
