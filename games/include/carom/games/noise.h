// Random errors of a player's strike.
#pragma once

#include <cstdint>
#include <string_view>

#include "carom/engine/row.h"
#include "carom/engine/scene.h"

namespace carom::games {

struct Noise {
    double speed = 0.0, aim_deg = 0.0, elevation_deg = 0.0, side = 0.0, height = 0.0;
    bool operator==(const Noise&) const = default;
};
constexpr auto rows_of(const Noise*) {
    return described("Noise", "Standard deviations of the independent normal errors of a strike.",
                     row<&Noise::speed>("speed", "[m/s]"), row<&Noise::aim_deg>("aim_deg", "[degrees]"),
                     row<&Noise::elevation_deg>("elevation_deg", "[degrees]"),
                     row<&Noise::side>("side", "Of the offset [ball radii]."),
                     row<&Noise::height>("height", "Of the offset [ball radii]."))
        .made_by_callers();
}

/// Noise by name:
///   "none" no errors
///   "fastfiz" 0.075 m/s, aim 0.125 degrees, elevation 0.1 degrees, offset 0.5 mm in both directions: the
///              default of class GaussianNoise of FastFiz (Noise.h), the simulator of the computational pool
///              championships
///   "ai3603" 0.1 m/s, aim and elevation 0.1 degrees, offset 0.003 ball radii in both directions:
///              noise_std of class PoolEnv of the course AI3603 (SJTU-RL2/AI3603-Billiards)
/// @param R radius of the struck ball [m], for errors in millimetres
/// @throws std::invalid_argument for another name, or a radius that is not greater than 0
Noise noise_by_name(std::string_view name, double R);

/// The strike of a player who intends `cue`. A pure function: shot `index` of a seed always has the same
/// errors, the ones that a sweep with `--vary cue.speed=normal(sd)` and so on draws (keys cue.speed,
/// cue.aim_deg, cue.elevation_deg, cue.offset.side, cue.offset.height).
///
/// The result is always legal (legal_strike): a negative speed becomes 0, an elevation below 0 becomes a
/// level cue, and an offset beyond the rim moves straight towards the centre until it is on the rim. At these
/// limits the errors are no longer normal.
/// @throws std::invalid_argument for a number that is not finite, or a negative standard deviation
Cue with_noise(const Cue& cue, const Noise& sd, std::uint64_t seed, std::uint64_t index);

}  // namespace carom::games
