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
#include <utility>
#include <vector>

#include "carom/engine/printable.h"
#include "facts.h"

namespace carom::games {
namespace {

using detail::GameRules;
using Book = GameRules::Book;

/// The rule behind a foul, by the order of Book.
struct FoulRules {
    Foul foul;
    std::array<const char*, 5> of;
};
constexpr const char* kPenalty = "WPBSA 3, penalties";
constexpr FoulRules kFoulRules[] = {
    {Foul::kCueBallPocketed, {"WPA 6.1", "", kPenalty, "", ""}},
    {Foul::kCueBallOff, {"WPA 6.1", "", kPenalty, "", ""}},
    {Foul::kNoBallHit, {"WPA 6.3", "", kPenalty, "pyramid, fouls", "four-ball, no ball hit"}},
    {Foul::kWrongBallFirst, {"WPA 6.2", "", kPenalty, "", ""}},
    {Foul::kNoCushion, {"WPA 6.3", "", "", "pyramid, fouls", ""}},
    {Foul::kBallOff, {"WPA 6.5", "UMB, fouls", kPenalty, "pyramid, fouls", "four-ball, ball off"}},
    {Foul::kPlacedOutside, {"WPA 6.10", "", kPenalty, "pyramid, break", ""}},
    {Foul::kBehindHeadString, {"WPA 6.11", "", "", "pyramid, break", ""}},
    {Foul::kThirdFoul, {"WPA 6.14", "", "WPBSA 3.14", "", ""}},
    {Foul::kWrongCueBall, {"", "UMB, fouls", "", "pyramid, break", "four-ball, cue balls"}},
    {Foul::kOpeningNotRed, {"", "UMB, starting position", "", "", "four-ball, starting position"}},
    {Foul::kWrongBallPocketed, {"", "", kPenalty, "", ""}},
    {Foul::kTwoBallsAtOnce, {"", "", kPenalty, "", ""}},
    {Foul::kJumpShot, {"option jump", "", kPenalty, "", ""}},
    {Foul::kBehindTheFreeBall, {"", "", "WPBSA 3, free ball", "", ""}},
    {Foul::kMiss, {"", "", "WPBSA 3.14", "", ""}},
    {Foul::kOpponentsBall, {"", "", "", "", "four-ball, opponent's ball"}},
    {Foul::kIntoTouchingBall, {"", "UMB, fouls", "", "", ""}},
};

void check(const State& state) {
    if (state.turn != 0 && state.turn != 1) throw std::invalid_argument("turn must be 0 or 1");
    const std::pair<const char*, int> numbers[] = {{"points", state.points[0]},
                                                   {"points", state.points[1]},
                                                   {"fouls", state.fouls[0]},
                                                   {"fouls", state.fouls[1]},
                                                   {"target", state.target}};
    const bool below_zero = detail::rules_of(state.game).below_zero;
    for (const auto& [what, number] : numbers) {
        const int least = below_zero && std::string_view(what) == "points" ? -kMostPoints : 0;
        if (number < least || number > kMostPoints)
            throw std::invalid_argument(std::string(what) + " = " + std::to_string(number) +
                                        " is out of range; it must be " + std::to_string(least) + " to " +
                                        std::to_string(kMostPoints));
    }
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
    if (call.push_out && state.game != Game::kNineBall && state.game != Game::kTenBall)
        throw std::invalid_argument(std::string(name(state.game)) + " has no push out; leave it out");
}

}  // namespace

const GameRules& detail::rules_of(Game game) {
    using Struck = GameRules::Struck;
    const auto pool = [](const char* book, auto legal, auto judge, std::vector<std::string_view> balls,
                         const char* break_rule, bool below_zero = false) -> GameRules {
        return {
            book, legal,      judge,     InHand::kHeadString, std::move(balls), Book::kPool, Struck::kCueBall,
            0,    below_zero, break_rule};
    };
    const auto carom = [](const char* book, Book fouls, std::vector<std::string_view> reds) -> GameRules {
        reds.insert(reds.begin(), {"white", "yellow"});
        return {book,
                legal_carom,
                judge_carom,
                InHand::kNo,
                std::move(reds),
                fouls,
                Struck::kOwn,
                0,
                fouls == Book::kFourBall,
                ""};
    };
    static const std::array<GameRules, 11> kGames = {
        pool("World Pool-Billiard Association, The Rules of Play, 15 March 2016: rule 3", legal_eight_ball,
             judge_eight_ball, {"cue", "8"}, "WPA 3.3"),
        pool("World Pool-Billiard Association, The Rules of Play, 15 March 2016: rule 2", legal_nine_ball,
             judge_nine_ball, {"cue", "9"}, "WPA 2.3"),
        carom("Union Mondiale de Billard, World rules of carom billiard", Book::kCarom, {"red"}),
        GameRules{"World Professional Billiards and Snooker Association, Official rules: section 3",
                  legal_snooker,
                  judge_snooker,
                  InHand::kD,
                  {"cue", "black"},
                  Book::kSnooker},
        GameRules{"pooltool 0.6.0 and LightZero's zoo",
                  legal_sum_to_three,
                  judge_sum_to_three,
                  InHand::kNo,
                  {"cue"},
                  Book::kCarom},
        pool("World Pool-Billiard Association, The Rules of Play, 15 March 2016: rule 9", legal_ten_ball,
             judge_ten_ball, {"cue", "10"}, "WPA 9.3"),
        pool("World Pool-Billiard Association, The Rules of Play, 15 March 2016: rule 4", legal_straight_pool,
             judge_straight_pool, {"cue"}, "WPA 4.10", true),
        GameRules{"Free Pyramid and Pyramid general rules, duplet.news, read in November 2026",
                  legal_free_pyramid,
                  judge_free_pyramid,
                  InHand::kHeadString,
                  {},
                  Book::kPyramid,
                  Struck::kAny,
                  8},
        carom("Union Mondiale de Billard, World rules of carom billiard: free game", Book::kCarom, {"red"}),
        carom("Union Mondiale de Billard, World rules of carom billiard: one cushion", Book::kCarom, {"red"}),
        carom("the Korean game of Wikipedia, Four-ball billiards, read in November 2026", Book::kFourBall,
              {"red1", "red2"}),
    };
    return kGames.at(static_cast<std::size_t>(game));
}

State new_game(Game game, int first, int target) {
    State state;
    state.game = game;
    state.turn = first;
    state.target = target != 0 ? target : detail::rules_of(game).target;
    state.in_hand = detail::rules_of(game).start;
    check(state);
    return state;
}

const char* book_of(Game game) {
    return detail::rules_of(game).book_name;
}

const char* rule_of(Game game, Foul foul) {
    const GameRules& rules = detail::rules_of(game);
    if (foul == Foul::kFewCushionsOnBreak) return rules.break_rule;
    const auto* row = std::find_if(std::begin(kFoulRules), std::end(kFoulRules),
                                   [foul](const FoulRules& r) { return r.foul == foul; });
    return row->of.at(static_cast<std::size_t>(rules.book));
}

Legal legal(const State& state, std::span<const std::string> balls) {
    check(state);
    Legal legal = detail::rules_of(state.game).legal(state, {balls.begin(), balls.end()});
    if (legal.first.empty()) throw std::invalid_argument("no ball is left to play at");
    legal.in_hand = state.in_hand;
    return legal;
}

Legal legal(const State& state, const Scene& scene) {
    Legal all = legal(state, ids_of(scene.ball));
    Legal beyond = all;
    std::erase_if(beyond.first, [&](const std::string& id) {
        const BallStart& ball = scene.ball[static_cast<std::size_t>(index_of(scene.ball, id))];
        return detail::is_behind_string(state, head_string(scene.table), ball.position.y());
    });
    return beyond.first.empty() ? all : beyond;
}

Verdict judge(const State& state, const Record& record, const Call& call) {
    check(state);
    check(state, record, call);
    const GameRules& rules = detail::rules_of(state.game);
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

}  // namespace carom::games
