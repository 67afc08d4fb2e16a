// Aims in a player's words: at a ball, at a part of it, at a diamond, into a pocket.
#pragma once

#include <string_view>
#include <vector>

#include "scene/reader.h"

namespace carom::detail {

/// Keys of [cue] that replace aim_deg or speed.
inline const std::vector<std::string_view> kAimKeys = {"aim_at", "aim_hit", "aim_diamond", "ghost",
                                                       "ball_speed"};

/// Sets aim_deg and speed by these keys. All balls of the scene must be known.
/// @param s  the section [cue], with the keys of cues and kAimKeys
/// @throws SceneError for two aims, two speeds, or an impossible one
void read_aim(const Section& s, const Scene& scene, Cue& cue);

/// Replaces these keys by the resulting aim_deg and speed; keeps ball_speed if it is to be varied.
void write_aim(toml::table& file, const Cue& cue, bool keep_ball_speed);

}  // namespace carom::detail
