#include "carom/games/rules.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "facts.h"

namespace carom::games {
namespace {

/// What a game is: a row of kGames, in the order of Game.
struct GameRules {
    Legal (*legal)(const State& state, const std::vector<std::string>& balls);
    Verdict (*judge)(const detail::Facts& facts);
    InHand start;                         ///< where the cue ball starts
    std::vector<std::string_view> balls;  ///< that the game needs
};

const GameRules& rules_of(Game game) {
    static const std::array<GameRules, 5> kGames = {
        {{detail::legal_eight_ball, detail::judge_eight_ball, InHand::kHeadString, {"cue", "8"}},
         {detail::legal_nine_ball, detail::judge_nine_ball, InHand::kHeadString, {"cue", "9"}},
         {detail::legal_three_cushion, detail::judge_three_cushion, InHand::kNo, {"white", "yellow", "red"}},
         {detail::legal_snooker, detail::judge_snooker, InHand::kD, {"cue", "black"}},
         {detail::legal_sum_to_three, detail::judge_sum_to_three, InHand::kNo, {"cue"}}}};
    return kGames.at(static_cast<std::size_t>(game));
}

/// The rule behind a foul: of pool, of three-cushion, of snooker.
struct FoulRules {
    Foul foul;
    const char *pool, *carom, *snooker;
};
constexpr FoulRules kFoulRules[] = {
    {Foul::kCueBallPocketed, "WPA 6.1", "", "WPBSA 3, penalties"},
    {Foul::kCueBallOff, "WPA 6.1", "", "WPBSA 3, penalties"},
    {Foul::kNoBallHit, "WPA 6.3", "", "WPBSA 3, penalties"},
    {Foul::kWrongBallFirst, "WPA 6.2", "", "WPBSA 3, penalties"},
    {Foul::kNoCushion, "WPA 6.3", "", ""},
    {Foul::kFewCushionsOnBreak, "WPA 2.3", "", ""},
    {Foul::kBallOff, "WPA 6.5", "UMB, fouls", "WPBSA 3, penalties"},
    {Foul::kPlacedOutside, "WPA 6.10", "", "WPBSA 3, penalties"},
    {Foul::kBehindHeadString, "WPA 6.11", "", ""},
    {Foul::kThirdFoul, "WPA 6.14", "", ""},
    {Foul::kWrongCueBall, "", "UMB, fouls", ""},
    {Foul::kOpeningNotRed, "", "UMB, starting position", ""},
    {Foul::kWrongBallPocketed, "", "", "WPBSA 3, penalties"},
    {Foul::kTwoBallsAtOnce, "", "", "WPBSA 3, penalties"},
    {Foul::kJumpShot, "", "", "WPBSA 3, penalties"},
    {Foul::kBehindTheFreeBall, "", "", "WPBSA 3, free ball"},
};

void check(const State& state) {
    if (state.turn != 0 && state.turn != 1) throw std::invalid_argument("turn must be 0 or 1");
    const std::pair<const char*, int> numbers[] = {{"points", state.points[0]},
                                                   {"points", state.points[1]},
                                                   {"fouls", state.fouls[0]},
                                                   {"fouls", state.fouls[1]},
                                                   {"target", state.target}};
    for (const auto& [what, number] : numbers)
        if (number < 0 || number > kMostPoints)
            throw std::invalid_argument(std::string(what) + " = " + std::to_string(number) +
                                        " is out of range; it must be 0 to " + std::to_string(kMostPoints));
    if (state.over) throw std::invalid_argument("the game is over; begin a new one");
}

}  // namespace

State new_game(Game game, int first, int target) {
    State state;
    state.game = game;
    state.turn = first;
    state.target = target;
    state.in_hand = rules_of(game).start;
    check(state);
    return state;
}

const char* rule_of(Game game, Foul foul) {
    const auto* row = std::find_if(std::begin(kFoulRules), std::end(kFoulRules),
                                   [foul](const FoulRules& r) { return r.foul == foul; });
    if (game == Game::kSnooker) return row->snooker;
    return game == Game::kEightBall || game == Game::kNineBall ? row->pool : row->carom;
}

Legal legal(const State& state, std::span<const std::string> balls) {
    check(state);
    Legal legal = rules_of(state.game).legal(state, {balls.begin(), balls.end()});
    if (legal.first.empty()) throw std::invalid_argument("no ball is left to play at");
    legal.in_hand = state.in_hand;
    return legal;
}

Verdict judge(const State& state, const Record& record, const Call& call) {
    check(state);
    const GameRules& rules = rules_of(state.game);
    for (const std::string_view ball : rules.balls)
        if (index_of(record, ball) < 0)
            throw std::invalid_argument("there is no ball \"" + std::string(ball) + "\" in the record; " +
                                        name(state.game) + " needs it");
    const detail::Facts facts(state, record, call);
    if (state.game != Game::kThreeCushion && !facts.struck("cue"))
        throw std::invalid_argument("the cue strikes ball \"" + facts.id(facts.shot.struck) +
                                    "\" and not the cue ball");
    return rules.judge(facts);
}

}  // namespace carom::games
