#include "base/game_state.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/console.h"
#include "carom/engine/printable.h"
#include "carom/interface/shape.h"

namespace carom::tools {
namespace {

// [bytes] A state takes about three hundred.
constexpr std::uintmax_t kLargestState = 1 << 16;

}  // namespace

std::vector<std::string> game_names() {
    std::vector<std::string> names;
    for (const games::Game game : games::all_of(games::Game{})) names.emplace_back(name(game));
    return names;
}

games::Game game_of(const std::string& name) {
    try {
        return games::game_named(name);
    } catch (const std::invalid_argument& refused) {
        throw UsageError(fmt::format("--game: {}", refused.what()));
    }
}

games::State read_state(const std::string& path) {
    const std::string shown = harmless(path);
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) throw UsageError(shown + ": there is no such file");
    if (std::filesystem::file_size(path, error) > kLargestState)
        throw UsageError(fmt::format("{}: expected a game state of less than 64 kB", shown));
    std::ifstream stream(path);
    std::stringstream text;
    text << stream.rdbuf();
    const auto value = interface::Value::parse(text.str(), nullptr, false);
    if (!value.is_object())
        throw UsageError(shown + ": expected a game state as written by carom judge --state-out");
    try {
        return interface::read_as<games::State>(value);
    } catch (const interface::ValueError& refused) {
        throw UsageError(fmt::format("{}: {}", shown, refused.what()));
    }
}

}  // namespace carom::tools
