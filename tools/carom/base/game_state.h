// The state of a game as a JSON file, with the keys of carom.games.State in Python.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "carom/games/rules.h"

namespace carom::tools {

/// @throws UsageError naming the option and the known games
games::Game game_of(const std::string& name);
/// The choices of --game.
std::vector<std::string> game_names();

nlohmann::ordered_json state_json(const games::State& state);

/// Reads a state from a file. @throws UsageError naming the file and the wrong key
games::State read_state(const std::string& path);

/// As above, from text; messages name it `shown`.
games::State parse_state(const std::string& text, const std::string& shown);

}  // namespace carom::tools
