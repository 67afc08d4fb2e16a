#include "carom/games/rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "carom/engine/printable.h"
#include "facts.h"

namespace carom::games {
namespace {

// In the order of carom_game in C.
constexpr Game kGames[] = {&kEightBall,    &kNineBall,   &kThreeCushion, &kSnooker,
                           &kSumToThree,   &kTenBall,    &kStraightPool, &kFreePyramid,
                           &kStraightRail, &kOneCushion, &kFourBall};

/// "WPA 6.1", or "" if the game has no rule for it.
const char* rule_of(Game game, Foul foul) {
    if (foul == Foul::kFewCushionsOnBreak) return game->break_rule;
    const auto row = std::find_if(game->fouls.begin(), game->fouls.end(),
                                  [foul](const FoulRule& of) { return of.foul == foul; });
    return row != game->fouls.end() ? row->rule : "";
}

void check(const State& state) {
    const auto check_number = [](const std::string& key, int number, const Whole& range) {
        if (number < range.least || number > range.most)
            throw std::invalid_argument(
                fmt::format("state.{}: expected a whole number from {} to {}", key, range.least, range.most));
    };
    each_row<State>([&]<auto kMember>(const Row<kMember>& row) {
        const auto& value = state.*kMember;
        Whole range = row.range;
        if (row.key == std::string_view("points") && !state.game->below_zero) range.least = 0;
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, int>) check_number(row.key, value, range);
        if constexpr (std::is_same_v<Value, std::array<int, 2>>)
            for (std::size_t i = 0; i < 2; ++i)
                check_number(fmt::format("{}[{}]", row.key, i), value[i], range);
    });
    if ((state.group[0] == Group::kOpen) != (state.group[1] == Group::kOpen) ||
        (state.group[0] != Group::kOpen && state.group[0] == state.group[1]))
        throw std::invalid_argument(std::string("the groups are ") + name(state.group[0]) + " and " +
                                    name(state.group[1]) +
                                    "; one player has solids and the other stripes, or both are open");
    if (!state.rules.empty()) {
        State read = state;
        complete(read);
    }
    if (state.over) throw std::invalid_argument("the game is over; begin a new one");
}

/// A call names balls and pockets that are there, and the game has a push out if one is called.
void check(const State& state, const Record& record, const Call& call) {
    const auto there = [](const char* what, const std::string& id, const std::vector<std::string>& ids) {
        if (id.empty() || detail::is_in(id, ids)) return;
        throw std::invalid_argument(
            fmt::format("the table has no {} {}; it has {}", what, in_quotes(id),
                        ids.empty() ? "none" : fmt::format("{}", fmt::join(ids, ", "))));
    };
    there("ball", call.ball, ids_of(record.tracks));
    there("pocket", call.pocket, ids_of(record.table.pockets));
    if (call.push_out && !state.game->info.has_push_out)
        throw std::invalid_argument(std::string(name(state.game)) + " has no push out; leave it out");
}

}  // namespace

const char* name(Game game) {
    return game->info.name.c_str();
}

const GameInfo& info_of(Game game) {
    return game->info;
}

std::span<const Game> all_of(Game) {
    return kGames;
}

Game game_named(std::string_view name) {
    std::string known;
    for (const Game game : kGames) {
        if (game->info.name == name) return game;
        known += (known.empty() ? "" : ", ") + game->info.name;
    }
    throw std::invalid_argument(fmt::format("no game {}; expected one of {}", in_quotes(name), known));
}

std::string next_text(const State& state) {
    if (state.over)
        return state.winner < 0 ? "the game is over, nobody wins"
                                : fmt::format("the game is over, player {} wins", state.winner + 1);
    std::string text = fmt::format("player {} shoots", state.turn + 1);
    if (state.in_hand == InHand::kAnywhere) text += ", cue ball in hand anywhere";
    if (state.in_hand == InHand::kHeadString) text += ", cue ball in hand behind the head string";
    if (state.in_hand == InHand::kD) text += ", cue ball in hand in the D";
    return text + (state.game->words != nullptr ? state.game->words(state) : "");
}

State new_game(Game game, int first, int target) {
    State state;
    state.game = game;
    state.turn = first;
    state.target = target != 0 ? target : game->info.target;
    state.in_hand = game->start;
    check(state);
    return state;
}

Legal legal(const State& state, std::span<const std::string> balls) {
    check(state);
    Legal legal = state.game->legal(state, {balls.begin(), balls.end()});
    if (legal.first.empty()) throw std::invalid_argument("no ball is left to play at");
    legal.in_hand = state.in_hand;
    return legal;
}

Legal detail::legal(const State& state, const std::vector<std::string>& balls,
                    const std::vector<std::string>& behind) {
    Legal legal = games::legal(state, balls);
    const std::vector<std::string> all = legal.first;
    std::erase_if(legal.first, [&](const std::string& id) { return is_in(id, behind); });
    if (legal.first.empty()) legal.first = all;
    return legal;
}

Legal legal(const State& state, const Scene& scene) {
    std::vector<std::string> behind;
    for (const BallStart& ball : scene.ball)
        if (detail::is_behind_string(state, head_string(scene.table), ball.position.y()))
            behind.push_back(ball.id);
    return detail::legal(state, ids_of(scene.ball), behind);
}

Verdict judge(const State& state, const Record& record, const Call& call) {
    check(state);
    check(state, record, call);
    const GameRules& rules = *state.game;
    for (const std::string_view ball : rules.balls)
        if (index_of(record, ball) < 0)
            throw std::invalid_argument("there is no ball \"" + std::string(ball) + "\"; " +
                                        name(state.game) + " needs it: add it, or name another game");
    const detail::Facts facts(state, record, call);
    if (rules.struck == GameRules::Struck::kCueBall && !facts.struck("cue"))
        throw std::invalid_argument("the cue strikes ball \"" + facts.id(facts.shot.struck) +
                                    "\" and not the cue ball");
    Verdict verdict = rules.judge(facts);
    for (CalledFoul& called : verdict.fouls) called.rule = rule_of(state.game, called.foul);
    return verdict;
}

void name_record(Verdict& verdict, const Record& record) {
    for (Option& option : verdict.options) option.record = record.hash();
}

}  // namespace carom::games
