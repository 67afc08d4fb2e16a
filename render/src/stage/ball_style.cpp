#include <array>
#include <cctype>
#include <cstdlib>
#include <string>
#include <string_view>

#include "carom/render/draw_list.h"
#include "carom/render/look.h"

namespace carom::render {

namespace {

using Color = std::array<float, 3>;

struct NamedColor {
    std::string_view name;
    Color color;
};

constexpr Color kWhite = {static_cast<float>(look::kIvory[0]), static_cast<float>(look::kIvory[1]),
                          static_cast<float>(look::kIvory[2])};

// Colours of the numbered balls 1 to 8 (8 is black); 9 to 15 have the first seven colours with stripes.
constexpr std::array<Color, 8> kPool{{{0.96F, 0.73F, 0.06F},
                                      {0.07F, 0.20F, 0.66F},
                                      {0.84F, 0.10F, 0.08F},
                                      {0.38F, 0.12F, 0.52F},
                                      {0.95F, 0.42F, 0.07F},
                                      {0.03F, 0.43F, 0.20F},
                                      {0.50F, 0.07F, 0.11F},
                                      {0.05F, 0.05F, 0.06F}}};

constexpr std::array<NamedColor, 9> kNamed{{{"white", kWhite},
                                            {"cue", kWhite},
                                            {"red", {0.80F, 0.06F, 0.08F}},
                                            {"yellow", {0.97F, 0.80F, 0.10F}},
                                            {"green", {0.02F, 0.42F, 0.24F}},
                                            {"brown", {0.42F, 0.22F, 0.08F}},
                                            {"blue", {0.10F, 0.28F, 0.75F}},
                                            {"pink", {0.95F, 0.52F, 0.63F}},
                                            {"black", {0.06F, 0.06F, 0.07F}}}};

int number_of(const std::string& id) {
    if (id.empty() || id.size() > 2) return 0;
    for (char c : id) {
        if (std::isdigit(static_cast<unsigned char>(c)) == 0) return 0;
    }
    return std::atoi(id.c_str());
}

}  // namespace

BallStyle ball_style(const std::string& id, const std::string& table_preset, int index) {
    BallStyle style;
    const int number = number_of(id);
    if (number > 0 && table_preset == "pyramid") {
        style.number = number;
        style.color = kWhite;
        style.pattern = BallPattern::kSolid;
        return style;
    }
    if (number > 0 && table_preset.starts_with("snooker")) {
        style.color = kNamed[2].color;
        style.pattern = BallPattern::kDots;
        return style;
    }
    if (number > 0) {
        style.number = number;
        style.color = kPool[number <= 8 ? number - 1 : (number - 9) % 7];
        style.pattern = number <= 8 ? BallPattern::kSolid : BallPattern::kStripe;
        return style;
    }
    for (const NamedColor& named : kNamed) {
        if (id.compare(0, named.name.size(), named.name) != 0) continue;
        style.color = named.color;
        style.pattern = BallPattern::kDots;
        return style;
    }
    style.color = kPool[index % 7];
    style.pattern = BallPattern::kHalves;
    return style;
}

}  // namespace carom::render
