// One reader per section of a scene file. Each receives the file's top level and reads its part of the scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/scene_number.h"
#include "carom/engine/tolerances.h"
#include "scene/reader.h"

namespace carom::detail {

/// Also sets the cushion model that belongs to the balls.
void read_balls(const Section& top, Scene& scene);
/// Gives the parts of a table their ids: "c1", "c2", ..., "j1", ..., "p1", ...
void number_parts(Table& table);
/// Refuses an incomplete arc, and a jaw with the keys of an arc.
void check_jaw(const Section& section, const Jaw& jaw);
/// Refuses measures of a preset that do not fit each other or the balls. @param section  [table]
void check_measures(const Section& section, const Scene& scene);
/// Needs scene.balls (default nose height), and sets their rolling friction if the cloth has a name.
void read_table(const Section& top, Scene& scene);
/// Balls placed one by one. Needs scene.balls.
void read_ball_list(const Section& top, Scene& scene);
/// The keys of a rack, in [rack] and [balls]; nothing if there is no [rack].
std::optional<Section> read_rack_keys(const Section& top, Rack& rack);
/// Racked balls, after the others. Needs scene.balls and scene.table.
void read_rack(const Section& top, Scene& scene);
/// Needs scene.ball.
void read_cue(const Section& top, Scene& scene);
/// Call after read_balls().
void read_physics(const Section& top, Scene& scene);
/// The plan checks these against the scene's needs.
void read_effects(const Section& top, Scene& scene);
void read_stop(const Section& top, Scene& scene);
void read_render(const Section& top, Scene& scene);

/// Rules about one section, for files and for scenes built in code. @throws SceneError
void check_id(const Section& section, const std::string& id);
void check_fits(const Section& section, const BallParams& balls);
void check_cushion(const Section& section, const Cushion& cushion);
/// Also checks that the ball exists and is at rest.
void check_cue(const Section& section, const Scene& scene, const Cue& cue);
/// Whether the kernel accepts the friction of the balls, and [physics] selects only one kernel.
void check_kernel(const Section& top, const Scene& scene);
void check_camera(const Section& section, const RenderSettings& render);

/// Rules that no single section can check: repeated ids, balls that overlap or reach into a cushion, noses
/// that no ball can meet, a run that would never end. @throws SceneError
void check_scene(const Section& top, const Scene& scene);
/// All rules that changed numbers can break, of sections and of check_scene(). @throws SceneError
void check_again(const Section& top, const Scene& scene, Change change);

/// A file as read by toml++. @throws SceneError if it cannot be read or is not TOML
toml::table read_toml(const std::string& path);
/// The same from text; messages use `name` for the file.
toml::table toml_from(std::string_view text, const std::string& name);
/// The whole file. @throws SceneError for a section that no scene has
Section top_of(const toml::table& file, const std::string& name);
/// The validated scene of a file; messages use `name` for the file. @throws SceneError
Scene scene_from(const toml::table& file, const std::string& name);

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
