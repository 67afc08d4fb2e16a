#include "base/game_state.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
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
    const auto names = games::names_of(games::Game{});
    return {names.begin(), names.end()};
}

games::Game game_of(const std::string& name) {
    const std::vector<std::string> names = game_names();
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == name) return static_cast<games::Game>(i);
    throw UsageError(fmt::format("--game {}: expected one of {}", name, fmt::join(names, ", ")));
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
