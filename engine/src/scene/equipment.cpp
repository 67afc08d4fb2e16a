// The built-in balls, cloths and cues. Sources of the numbers, and their reliability:
// docs/reference/physics.md, "Where the numbers come from".
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "base/nearest.h"
#include "carom/engine/cushion.h"
#include "carom/engine/printable.h"
#include "carom/engine/scene.h"

namespace carom {
namespace {

struct BallPreset {
    const char* name;
    BallParams balls;
    const CushionModelInfo* cushion;
    BallSize cue = {0.0, 0.0};  ///< of the cue ball; R = 0: like the others
};

/// The values that most simulators share: one set of coefficients for every game, and ball-ball friction
/// independent of the slip.
constexpr BallParams classic(double R, double m) {
    return {.R = R,
            .m = m,
            .mu_s = 0.2,
            .mu_r = 0.01,
            .mu_sp = 0.0127,
            .mu_b = 0.05,
            .e_b = 0.95,
            .e_c = 0.85,
            .f_c = 0.2};
}
constexpr BallParams kPoolClassic = classic(0.028575, 0.170097), kSnookerClassic = classic(0.02625, 0.140),
                     kCaromClassic = classic(0.03075, 0.21);

/// The fit of Alciatore's TP A.14 to Marlow's measurements.
constexpr BallParams pool() {
    BallParams p = kPoolClassic;
    p.mu_b = 0.009951, p.mu_b_more = 0.108, p.mu_b_fall = 1.088;
    return p;
}

/// Rolling friction: Mathavan, Jackson, Parkin (2009), 0.124 to 0.126 m/s^2. Cushion: the same authors'
/// rebounds of a rolling ball, which their model of 2010 reproduces up to 3.5 m/s if the restitution falls
/// with speed. The models of an impact in the air lose 27 % more of the speed.
constexpr BallParams snooker() {
    BallParams p = kSnookerClassic;
    p.mu_r = 0.0128, p.f_c = 0.14;
    p.e_c = 1.0, p.e_c_fall = 0.08, p.e_c_above = 1.7;
    return p;
}

/// Measured on 182 tracked shots of a three-cushion match: rolling friction from 1900 stretches, cushion from
/// paths and single impacts (lab/notes/2026-11-presets.md).
constexpr BallParams carom_balls() {
    BallParams p = kCaromClassic;
    p.mu_r = 0.0045;
    p.e_c = 0.9, p.e_c_fall = 0.02;
    p.f_c = 0.19, p.f_c_more = 0.23, p.f_c_fall = 0.7;
    return p;
}

/// English pool balls of 2 in, with a cue ball of 1 7/8 in; masses by volume from a pool ball of the same
/// resin. Coefficients as for pool.
constexpr double by_volume(double R) {
    const double ratio = R / kPoolClassic.R;
    return kPoolClassic.m * (ratio * ratio * ratio);
}
constexpr BallParams english_pool() {
    BallParams p = pool();
    p.R = 1.0 * 0.0254, p.m = by_volume(p.R);
    return p;
}
/// Balls of Russian pyramid, 68 mm, of the same resin: 0.287 kg. Coefficients as for pool.
constexpr BallParams pyramid_balls() {
    BallParams p = pool();
    p.R = 0.034, p.m = by_volume(p.R);
    return p;
}
constexpr double kOversized = 2.375 / 2.0 * 0.0254, kEnglishCue = 1.875 / 2.0 * 0.0254, kOunce = 0.028349523;

/// In the order of kBallPresets. The oversized cue ball of a coin-operated table measures 2 3/8 in and is of
/// the same resin; a magnetic one has the usual size, and is half an ounce to an ounce heavier.
constexpr BallPreset kBalls[] = {
    {"pool", pool(), &kHan2005},
    {"snooker", snooker(), &kMathavan2010},
    {"carom", carom_balls(), &kHan2005},
    {"bar_box_oversized", pool(), &kHan2005, {kOversized, by_volume(kOversized)}},
    {"bar_box_heavy", pool(), &kHan2005, {pool().R, pool().m + 0.75 * kOunce}},
    {"english_pool", english_pool(), &kHan2005, {kEnglishCue, by_volume(kEnglishCue)}},
    {"pyramid", pyramid_balls(), &kHan2005},
    {"pool_classic", kPoolClassic, &kHan2005},
    {"snooker_classic", kSnookerClassic, &kHan2005},
    {"carom_classic", kCaromClassic, &kHan2005}};

struct CuePreset {
    const char* name;
    double mass, end_mass;  ///< [kg]
    double restitution;
};

/// In the order of kCuePresets. End masses: the mass of a pool ball divided by the ratios of Alciatore's TP
/// B.1 (Predator Z 29.2 and similar; Players 20.1; Stinger break cue 12.0). Restitution: leather 0.71 to
/// 0.75, phenolic 0.81 to 0.87 (Alciatore, physical properties).
constexpr CuePreset kCues[] = {{"low_deflection", 0.567, 0.00567, 0.73},
                               {"plain", 0.567, 0.00844, 0.73},
                               {"break", 0.567, 0.01417, 0.84},
                               {"lossless", 0.567, 0.00567, 1.0}};

struct Cloth {
    const char* name;
    double mu_r;
};

/// In the order of kCloths. A lag of 7 to 8.5 s on a nine-foot table is 0.0106 to 0.0072 (Jewett); the heated
/// cloth of a three-cushion match was measured at 0.0043 to 0.0051.
constexpr Cloth kClothFriction[] = {{"club", 0.01}, {"tournament", 0.0075}, {"match_heated", 0.0045}};

template <class Row, std::size_t kRows>
const Row& named(const Row (&rows)[kRows], std::string_view name, const char* what) {
    const Row* row = std::find_if(rows, std::end(rows), [&](const Row& r) { return r.name == name; });
    if (row != std::end(rows)) return *row;
    std::vector<std::string_view> names;
    for (const Row& r : rows) names.emplace_back(r.name);
    throw std::invalid_argument(
        fmt::format("unknown {} {}{}", what, in_quotes(name), did_you_mean(name, names)));
}

}  // namespace

BallParams make_ball_params(std::string_view preset) {
    return named(kBalls, preset, "ball preset").balls;
}

void use_balls(Scene& scene, std::string_view preset) {
    const BallPreset& row = named(kBalls, preset, "ball preset");
    scene.ball_preset = row.name;
    scene.balls = row.balls;
    scene.cue_ball.reset();
    if (row.cue.R > 0.0) scene.cue_ball = row.cue;
    scene.physics.cushion = row.cushion;
}

void use_cue(Cue& cue, std::string_view preset) {
    const CuePreset& row = named(kCues, preset, "cue preset");
    cue.preset = row.name;
    cue.mass = row.mass;
    cue.end_mass = row.end_mass;
    cue.restitution = row.restitution;
}

double cloth_mu_r(std::string_view cloth) {
    return named(kClothFriction, cloth, "cloth").mu_r;
}

std::optional<std::array<double, 3>> color_of(std::string_view text) {
    if (text.size() != 7 || text[0] != '#') return std::nullopt;
    std::array<double, 3> color{};
    for (std::size_t k = 0; k < color.size(); ++k) {
        int channel = 0;
        const char *const first = text.data() + 1 + 2 * k, *const last = first + 2;
        if (std::from_chars(first, last, channel, 16).ptr != last || channel < 0) return std::nullopt;
        color[k] = channel / 255.0;
    }
    return color;
}

}  // namespace carom
