// Options of the games' rules.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/engine/printable.h"
#include "facts.h"

namespace carom::games {
namespace {

const std::vector<RuleOption>& table() {
    static const std::vector<RuleOption> kTable = {
        {Game::kEightBall,
         "call",
         {"all", "eight", "none"},
         "Shots to call: all, only the one at the eight, or none."},
        {Game::kEightBall,
         "eight_on_break",
         {"respot", "wins", "rerack"},
         "Effect of an eight that falls on the break: a respot or rerack, as the next player chooses; a win, "
         "or a loss after a foul; or always a rerack."},
        {Game::kEightBall,
         "in_hand",
         {"anywhere", "behind_line"},
         "Area of the cue ball in hand after a foul: anywhere, or behind the head string."},
        {Game::kEightBall,
         "jump",
         {"fair", "foul"},
         "Whether the cue ball may pass over a ball before it hits one."},
        {Game::kNineBall, "push_out", {"true", "false"}, "The shot after the break may be a push out."},
        {Game::kNineBall, "three_fouls", {"true", "false"}, "Three fouls in a row lose the rack."},
        {Game::kNineBall,
         "nine_on_break",
         {"wins", "respot"},
         "Effect of a nine that falls on a fair break."},
        {Game::kSnooker,
         "miss",
         {"false", "true"},
         "A foul that hits no ball on first, although a straight path to one was clear, is a miss: the other "
         "player may have the balls replaced."},
        {Game::kTenBall, "push_out", {"true", "false"}, "The shot after the break may be a push out."},
        {Game::kTenBall, "three_fouls", {"true", "false"}, "Three fouls in a row lose the rack."},
        {Game::kTenBall,
         "early_ten",
         {"respot", "wins"},
         "Effect of a called ten that falls while other balls are left."},
        {Game::kFourBall,
         "opponents_ball",
         {"foul", "counts"},
         "Effect of hitting the other player's cue ball: a foul, as in Korea, or the same as hitting a red, "
         "as in Japan."}};
    return kTable;
}

/// The value that a state has chosen for an option, or "".
std::string_view chosen(const State& state, std::string_view key) {
    for (const std::string_view option : state.rules)
        if (option.size() > key.size() && option.starts_with(key) && option[key.size()] == '=')
            return option.substr(key.size() + 1);
    return {};
}

}  // namespace

std::span<const RuleOption> rule_options() {
    return table();
}

void set_rule(State& state, std::string_view option) {
    const std::size_t equals = std::min(option.find('='), option.size());
    const std::string_view key = option.substr(0, equals);
    std::vector<std::string> rules, known;
    bool is_known = false;
    // Rules keep the order of the game's options, so that equal states compare equal.
    for (const RuleOption& row : table()) {
        if (row.game != state.game) continue;
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
    for (const RuleOption& row : table())
        if (row.game == state.game && row.key == key) return row.values[0];
    throw std::logic_error("the game has no option " + std::string(key));
}

}  // namespace carom::games
