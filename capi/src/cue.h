// The cue of the C interface and that of the engine.
#pragma once

#include <iterator>
#include <string>
#include <utility>

#include "carom/carom.h"
#include "carom/engine/scene.h"

namespace carom::c {

/// The members that both cue structs have.
inline constexpr std::pair<double carom_cue::*, double carom::Cue::*> kCueNumbers[] = {
    {&carom_cue::speed, &carom::Cue::speed},
    {&carom_cue::aim_deg, &carom::Cue::aim_deg},
    {&carom_cue::elevation_deg, &carom::Cue::elevation_deg},
    {&carom_cue::side, &carom::Cue::side},
    {&carom_cue::height, &carom::Cue::height},
    {&carom_cue::mass, &carom::Cue::mass},
    {&carom_cue::end_mass, &carom::Cue::end_mass},
    {&carom_cue::restitution, &carom::Cue::restitution}};
static_assert(sizeof(carom_cue) == std::size(kCueNumbers) * sizeof(double));

/// The engine's cue for the caller's, striking this ball.
inline Cue cue_of(const std::string& id, const carom_cue& cue) {
    Cue c;
    c.ball = id;
    for (const auto& [theirs, ours] : kCueNumbers) c.*ours = cue.*theirs;
    return c;
}

/// The caller's cue for the engine's.
inline carom_cue cue_of(const Cue& cue) {
    carom_cue c;
    for (const auto& [theirs, ours] : kCueNumbers) c.*theirs = cue.*ours;
    return c;
}

}  // namespace carom::c
