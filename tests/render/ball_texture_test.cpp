// Textures of balls for other programs match the renderer's balls, and each look is defined once.
#include "carom/render/ball_texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <regex>
#include <set>
#include <string>

#include "carom/render/draw_list.h"

namespace carom::render {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kWidth = 512;

/// The colour in a direction of the ball's frame, 0..255.
std::array<int, 3> colour_at(const Image& image, double x, double y, double z) {
    const double length = std::sqrt(x * x + y * y + z * z), theta = std::acos(x / length);
    double phi = std::atan2(z, y);
    if (phi < 0.0) phi += 2.0 * kPi;
    const int i = static_cast<int>(phi / (2.0 * kPi) * kWidth) % kWidth,
              j = std::min(static_cast<int>(theta / kPi * kWidth / 2), kWidth / 2 - 1);
    const std::uint8_t* const p = image.pixel(i, j);
    return {p[0], p[1], p[2]};
}

std::array<int, 3> bytes(float r, float g, float b) {
    return {static_cast<int>(std::lround(255.0F * r)), static_cast<int>(std::lround(255.0F * g)),
            static_cast<int>(std::lround(255.0F * b))};
}

const std::array<int, 3> kIvory = bytes(0.95F, 0.93F, 0.86F), kInk = bytes(0.11F, 0.11F, 0.11F);

std::array<int, 3> own(const BallStyle& style) {
    return bytes(style.color[0], style.color[1], style.color[2]);
}

/// Ink pixels on the half of the texture around one end of the z axis.
long ink(const Image& image, bool upper) {
    long count = 0;
    for (int j = 0; j < image.size.height; ++j)
        for (int i = upper ? 0 : kWidth / 2; i < (upper ? kWidth / 2 : kWidth); ++i)
            count += image.pixel(i, j)[0] == kInk[0] ? 1 : 0;
    return count;
}

TEST(BallTexture, AStripeIsAroundTheXAxis) {
    const BallStyle style = ball_style("12", "nine_foot", 12);
    const Image image = ball_texture(style, kWidth);
    EXPECT_EQ(image.size.width, kWidth);
    EXPECT_EQ(image.size.height, kWidth / 2);
    for (const double side : {-1.0, 1.0}) {
        EXPECT_EQ(colour_at(image, side, 0.0, 0.0), kIvory);
        EXPECT_EQ(colour_at(image, 0.62 * side, 0.784, 0.0), kIvory);
        EXPECT_EQ(colour_at(image, 0.58 * side, 0.814, 0.0), own(style));
        EXPECT_EQ(colour_at(image, 0.0, side, 0.0), own(style));
        // The number's disc: 0.52 of the radius.
        EXPECT_EQ(colour_at(image, 0.0, 0.49, 0.872 * side), kIvory);
        EXPECT_EQ(colour_at(image, 0.0, 0.55, 0.835 * side), own(style));
    }
}

TEST(BallTexture, BothEndsOfTheZAxisShowTheNumber) {
    const Image one = ball_texture(ball_style("1", "nine_foot", 1), kWidth);
    EXPECT_GT(ink(one, true), 100);
    EXPECT_EQ(ink(one, true), ink(one, false));
    // The stroke of the 1 passes through the middle; its right is empty.
    EXPECT_EQ(colour_at(one, 0.0, 0.0, 1.0), kInk);
    EXPECT_EQ(colour_at(one, 0.0, 0.3, 0.954), kIvory);
    // Upright with +y on the right; from above that is -x. The bar of the 6 is below it.
    for (const double side : {-1.0, 1.0}) {
        const Image six = ball_texture(ball_style("6", "nine_foot", 6), kWidth);
        EXPECT_EQ(colour_at(six, 0.43 * side, 0.0, 0.903 * side), kInk);
        EXPECT_EQ(colour_at(six, -0.43 * side, 0.0, 0.903 * side), kIvory);
    }
}

TEST(BallTexture, OneDotOfSixIsLarger) {
    const BallStyle white = ball_style("white", "carom", 0), red = ball_style("red", "carom", 1);
    const Image dotted = ball_texture(white, kWidth);
    const std::array<int, 3> dot = bytes(0.72F, 0.05F, 0.07F);
    EXPECT_EQ(colour_at(dotted, 0.0, 0.3, 0.954), dot);
    EXPECT_EQ(colour_at(dotted, 0.0, 0.3, -0.954), own(white));
    EXPECT_EQ(colour_at(dotted, 0.0, 0.1, -0.995), dot);
    EXPECT_EQ(colour_at(dotted, 0.995, 0.1, 0.0), dot);
    EXPECT_EQ(colour_at(dotted, 0.7, 0.7, 0.0), own(white));
    // A dark ball has pale dots.
    EXPECT_EQ(colour_at(ball_texture(red, kWidth), 0.0, 0.0, 1.0), bytes(0.93F, 0.90F, 0.82F));
}

/// The colours in a text: three numbers with decimal points in a row.
std::set<std::array<double, 3>> colours_in(const std::filesystem::path& path) {
    static const std::regex kThree(R"((\d?\.\d+)F?, *(\d?\.\d+)F?, *(\d?\.\d+))");
    std::ifstream file(path);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    std::set<std::array<double, 3>> found;
    for (auto at = std::sregex_iterator(text.begin(), text.end(), kThree); at != std::sregex_iterator(); ++at)
        found.insert({std::stod((*at)[1]), std::stod((*at)[2]), std::stod((*at)[3])});
    return found;
}

TEST(Look, EachColourIsDefinedOnce) {
    const std::filesystem::path source = CAROM_SOURCE_DIR,
                                header = source / "render/include/carom/render/look.h";
    const auto look = colours_in(header);
    ASSERT_EQ(look.size(), 17u);
    int files = 0;
    for (const char* folder : {"render", "tools/carom", "python"}) {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(source / folder)) {
            if (!entry.is_regular_file() || entry.path() == header) continue;
            ++files;
            for (const auto& colour : colours_in(entry.path()))
                EXPECT_EQ(look.count(colour), 0u)
                    << entry.path() << ": " << colour[0] << ", " << colour[1] << ", " << colour[2];
        }
    }
    EXPECT_GT(files, 100);
}

}  // namespace
}  // namespace carom::render
