// The look of a table and its balls, for everything that paints them. The build makes the same constants,
// with the same names, for the shaders and for the pages (render/look.cmake), so each must be on its own
// line. A colour is a screen value: its square is the reflected radiance.
#pragma once

#include <array>
#include <string_view>

namespace carom::render::look {

using Color = std::array<double, 3>;

inline constexpr Color kCloth{0.03, 0.47, 0.32};
inline constexpr Color kCaromCloth{0.06, 0.29, 0.58};
inline constexpr Color kSnookerCloth{0.05, 0.45, 0.19};
inline constexpr Color kWoodDark{0.21, 0.085, 0.045};
inline constexpr Color kWoodLight{0.43, 0.205, 0.10};
inline constexpr Color kLeather{0.29, 0.185, 0.12};
inline constexpr Color kTrim{0.16, 0.125, 0.105};
inline constexpr Color kInlay{0.88, 0.85, 0.76};
inline constexpr Color kFloor{0.30, 0.215, 0.155};
inline constexpr Color kWall{0.27, 0.29, 0.31};
inline constexpr Color kLampShade{0.05, 0.16, 0.12};
/// [-] Factor by which the cloth of a cushion reflects more light.
inline constexpr double kCushionGain = 1.12;
/// [-] Reflectance of chalk.
inline constexpr double kChalk = 0.75;

// Surfaces that others shade, in one colour each: the mean of what is painted here.
inline constexpr Color kPlainWood{0.35, 0.176, 0.091};
inline constexpr Color kPlainPocket{0.12, 0.092, 0.078};
inline constexpr Color kPlainChalk{0.45, 0.62, 0.54};

/// The cloth of a game, by the preset of its table.
constexpr Color cloth_of(std::string_view preset) {
    return preset.starts_with("carom") ? kCaromCloth : preset.starts_with("snooker") ? kSnookerCloth : kCloth;
}

// Balls; their own colours are those of ball_style().
inline constexpr Color kIvory{0.95, 0.93, 0.86};
inline constexpr Color kRedDot{0.72, 0.05, 0.07};
inline constexpr Color kPaleDot{0.93, 0.90, 0.82};
/// [-] Reflectance of a digit, and its screen value.
inline constexpr double kInk = 0.012;
inline constexpr double kInkOnScreen = 0.11;
/// [-] A ball of at least this luminance is bright: its dots are red.
inline constexpr double kBright = 0.3;
/// [-] Share of white in the second half of a ball of two halves.
inline constexpr double kPaleHalf = 0.65;
/// [radii] Half the width of a stripe; the ivory disc behind a number, the dots, and the larger dot.
inline constexpr double kStripe = 0.60;
inline constexpr double kSpot = 0.52;
inline constexpr double kDot = 0.17;
inline constexpr double kLargeDot = 0.34;

/// For a ball with these reflectances of red, green and blue [-].
inline bool is_bright(float r, float g, float b) {
    return 0.3F * r + 0.6F * g + 0.1F * b > static_cast<float>(kBright);
}

}  // namespace carom::render::look
