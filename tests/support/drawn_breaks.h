// Breaks from any place behind the head string, off the middle of the first ball.
#pragma once

#include <fmt/format.h>

#include <set>
#include <string>

#include "carom/engine/record.h"
#include "carom/engine/scene.h"
#include "reference/random_impacts.h"

namespace carom::test {

inline Scene drawn_break(const std::string& game, reference::Generator& rng) {
    const double x = rng.uniform(0.2, 1.07), y = rng.uniform(0.1, 0.63), aim = rng.uniform(-0.9, 0.9),
                 speed = rng.uniform(6.0, 10.0);
    return parse_scene(fmt::format("[table]\npreset = \"nine_foot\"\n[balls]\npreset = \"pool\"\n"
                                   "[rack]\ngame = \"{}\"\n[cue]\nball = \"cue\"\nball_speed = {}\n"
                                   "aim_hit = [\"1\", {}]\n[[ball]]\nid = \"cue\"\nposition = [{}, {}]\n",
                                   game, speed, aim, x, y),
                       "s.toml");
}

inline std::set<std::string> potted(const Record& record) {
    std::set<std::string> balls;
    for (const BallTrack& track : record.tracks)
        if (track.segments.back().state == MotionState::kPocketed) balls.insert(track.id);
    return balls;
}

}  // namespace carom::test
