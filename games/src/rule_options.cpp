// Options of the games' rules. A state keeps the chosen value of each option in two bits, in the order of the
// game's rows.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/printable.h"
#include "facts.h"

namespace carom::games {
namespace {

constexpr unsigned kBits = 2;
constexpr std::uint32_t kMask = (1U << kBits) - 1;

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

std::vector<const RuleOption*> options_of(Game game) {
    std::vector<const RuleOption*> list;
    for (const RuleOption& option : table())
        if (option.game == game) list.push_back(&option);
    return list;
}

std::uint32_t chosen(const State& state, std::size_t option) {
    return state.rules >> (kBits * option) & kMask;
}

}  // namespace

std::span<const RuleOption> rule_options() {
    return table();
}

void set_rule(State& state, std::string_view option) {
    const std::size_t equals = std::min(option.find('='), option.size());
    const std::string_view key = option.substr(0, equals);
    const std::vector<const RuleOption*> options = options_of(state.game);
    std::string known;
    for (std::size_t i = 0; i < options.size(); ++i) {
        const RuleOption& row = *options[i];
        known += (i == 0 ? "" : ", ") + std::string(row.key);
        if (key != row.key) continue;
        for (std::uint32_t value = 0; equals < option.size() && value < row.values.size(); ++value) {
            if (option.substr(equals + 1) != row.values[value]) continue;
            state.rules = (state.rules & ~(kMask << (kBits * i))) | value << (kBits * i);
            return;
        }
        throw std::invalid_argument(fmt::format("{}: expected {}={}", harmless(std::string(option)), row.key,
                                                fmt::join(row.values, "|")));
    }
    throw std::invalid_argument(
        options.empty()
            ? fmt::format("{} has no options; leave out {}", name(state.game), in_quotes(std::string(key)))
            : fmt::format("{} has no option {}; it has {}", name(state.game), in_quotes(std::string(key)),
                          known));
}

std::vector<std::string> chosen_rules(const State& state) {
    std::vector<std::string> list;
    const std::vector<const RuleOption*> options = options_of(state.game);
    for (std::size_t i = 0; i < options.size(); ++i)
        if (const std::uint32_t value = chosen(state, i); value > 0 && value < options[i]->values.size())
            list.push_back(std::string(options[i]->key) + "=" + options[i]->values[value]);
    return list;
}

namespace detail {

bool has_its_rules(const State& state) {
    const std::vector<const RuleOption*> options = options_of(state.game);
    std::uint32_t rest = state.rules;
    for (const RuleOption* option : options) {
        if ((rest & kMask) >= option->values.size()) return false;
        rest >>= kBits;
    }
    return rest == 0;
}

std::string_view rule(const State& state, std::string_view key) {
    const std::vector<const RuleOption*> options = options_of(state.game);
    for (std::size_t i = 0; i < options.size(); ++i)
        if (key == options[i]->key) return options[i]->values.at(chosen(state, i));
    throw std::logic_error("the game has no option " + std::string(key));
}

}  // namespace detail
}  // namespace carom::games
