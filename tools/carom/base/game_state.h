// Values of the interface in files and in messages of the program.
#pragma once

#include <string>
#include <vector>

#include "carom/games/rules.h"

namespace carom::tools {

/// @throws UsageError naming the option and the known games
games::Game game_of(const std::string& name);
/// The choices of --game.
std::vector<std::string> game_names();

/// Reads a state from a file. @throws UsageError naming the file and the wrong key
games::State read_state(const std::string& path);

}  // namespace carom::tools
