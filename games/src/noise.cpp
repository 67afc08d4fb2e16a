#include "carom/games/noise.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "base/draws.h"
#include "carom/engine/strike.h"

namespace carom::games {

Noise noise_by_name(std::string_view name, double R) {
    if (!(R > 0.0) || !std::isfinite(R))
        throw std::invalid_argument("the ball's radius must be greater than 0");
    if (name == "none") return {};
    if (name == "fastfiz") return {0.075, 0.125, 0.1, 0.5e-3 / R, 0.5e-3 / R};
    if (name == "ai3603") return {0.1, 0.1, 0.1, 0.003, 0.003};
    throw std::invalid_argument("unknown noise \"" + std::string(name) +
                                "\"; use none, fastfiz, ai3603 or your own standard deviations");
}

Cue with_noise(const Cue& cue, const Noise& sd, std::uint64_t seed, std::uint64_t index) {
    const struct {
        const char* key;
        double Cue::*number;
        double deviation;
    } kErrors[] = {{"cue.speed", &Cue::speed, sd.speed},
                   {"cue.aim_deg", &Cue::aim_deg, sd.aim_deg},
                   {"cue.elevation_deg", &Cue::elevation_deg, sd.elevation_deg},
                   {"cue.offset.side", &Cue::side, sd.side},
                   {"cue.offset.height", &Cue::height, sd.height}};
    Cue struck = cue;
    for (const auto& [key, number, deviation] : kErrors) {
        if (!(deviation >= 0.0) || !std::isfinite(deviation))
            throw std::invalid_argument(std::string("the standard deviation of ") + key +
                                        " must be a finite number of at least 0");
        SplitMix64 random = draws_of(seed, index, key);
        struck.*number = struck.*number + deviation * standard_normal(random);
    }
    return legal_strike(struck);
}

}  // namespace carom::games
