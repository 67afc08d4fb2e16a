// Options of the games' rules.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/engine/printable.h"
#include "facts.h"

namespace carom::games {
namespace {

/// The value that a state has chosen for an option, or "".
std::string_view chosen(const State& state, std::string_view key) {
    for (const std::string_view option : state.rules)
        if (option.size() > key.size() && option.starts_with(key) && option[key.size()] == '=')
            return option.substr(key.size() + 1);
    return {};
}

}  // namespace

std::vector<GameInfo> all_games() {
    std::vector<GameInfo> list;
    for (const Game game : all_of(Game{})) list.push_back(info_of(game));
    return list;
}

void set_rule(State& state, std::string_view option) {
    const std::size_t equals = std::min(option.find('='), option.size());
    const std::string_view key = option.substr(0, equals);
    std::vector<std::string> rules, known;
    bool is_known = false;
    // Rules keep the order of the game's options, so that equal states compare equal.
    for (const RuleOption& row : state.game->info.options) {
        known.push_back(row.key);
        std::string_view value = chosen(state, row.key);
        if (key == row.key) {
            is_known = true;
            value = option.substr(std::min(equals + 1, option.size()));
            if (std::find(row.values.begin(), row.values.end(), value) == row.values.end())
                throw std::invalid_argument(
                    fmt::format("{}: expected {}={}", harmless(option), row.key, fmt::join(row.values, "|")));
        }
        if (!value.empty() && value != row.values[0]) rules.push_back(fmt::format("{}={}", row.key, value));
    }
    if (is_known) {
        state.rules = rules;
        return;
    }
    throw std::invalid_argument(
        known.empty() ? fmt::format("{} has no options; leave out {}", name(state.game), in_quotes(key))
                      : fmt::format("{} has no option {}; it has {}", name(state.game), in_quotes(key),
                                    fmt::join(known, ", ")));
}

void complete(State& state) {
    try {
        for (const std::string& option : std::exchange(state.rules, {})) set_rule(state, option);
    } catch (const std::invalid_argument& refused) {
        throw std::invalid_argument(std::string("rules: ") + refused.what());
    }
}

std::string_view detail::rule(const State& state, std::string_view key) {
    if (const std::string_view value = chosen(state, key); !value.empty()) return value;
    for (const RuleOption& row : state.game->info.options)
        if (row.key == key) return row.values[0];
    throw std::logic_error("the game has no option " + std::string(key));
}

}  // namespace carom::games
