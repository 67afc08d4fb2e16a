// Rules of games: legal shots, and the outcome of a shot. Pure functions of a state, the balls and a record.
//
// GameInfo names the published rules of each game.
//
// Rules about facts that a record does not contain are not judged: feet, touched balls, double hits, pushes,
// time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/record.h"
#include "carom/engine/row.h"
#include "carom/games/spots.h"

namespace carom::games {

struct GameRules;
/// A game is a pointer to its row, which stands in the file of its rules.
using Game = const GameRules*;
using carom::name;
const char* name(Game game);
std::span<const Game> all_of(Game);
/// @throws std::invalid_argument listing the known names
Game game_named(std::string_view name);
extern const GameRules kEightBall, kNineBall, kThreeCushion, kSnooker, kSumToThree, kTenBall, kStraightPool,
    kFreePyramid, kStraightRail, kOneCushion, kFourBall;

/// A player's balls in eight-ball.
enum class Group : std::uint8_t { kOpen, kSolids, kStripes };
constexpr auto names_of(Group) {
    return std::array{"open", "solids", "stripes"};
}

/// The ball on in snooker. kColour: any colour, after a red. The colours have their points as numbers.
enum class BallOn : std::uint8_t { kColour, kRed, kYellow, kGreen, kBrown, kBlue, kPink, kBlack };
constexpr auto names_of(BallOn) {
    return std::array{"colour", "red", "yellow", "green", "brown", "blue", "pink", "black"};
}

/// More points than any game has, and fewer than an int holds.
inline constexpr int kMostPoints = 1000000000;

/// A game reads only its own fields.
struct State {
    Game game = &kEightBall;
    int turn = 0;
    bool opening = true;
    InHand in_hand = InHand::kNo;
    std::array<int, 2> points = {0, 0};
    int target = 0;
    bool over = false;
    int winner = -1;
    std::array<Group, 2> group = {Group::kOpen, Group::kOpen};
    bool may_push_out = false;
    std::array<int, 2> fouls = {0, 0};
    BallOn on = BallOn::kRed;
    bool free_ball = false;
    std::vector<std::string> rules;
    bool operator==(const State&) const = default;
};
constexpr auto rows_of(const State*) {
    return described(
               "State",
               "The memory of a game between two shots. Players are 0 and 1; a pair has a value for each.",
               row<&State::game>("game", "The game.").needed(),
               row<&State::turn>("turn", "Whose shot it is.", {0, 1}),
               row<&State::opening>("opening", "The break, or the first shot of a carom game."),
               row<&State::in_hand>("in_hand", "Of the cue ball: its area."),
               row<&State::points>("points", "Below 0 in straight pool and four-ball.",
                                   {-kMostPoints, kMostPoints}),
               row<&State::target>("target", "Points that win; 0: no end.", {0, kMostPoints}),
               row<&State::over>("over", "The game is over."),
               row<&State::winner>("winner", "-1: none, or not yet.", {-1, 1}),
               row<&State::group>("group", "Eight-ball."),
               row<&State::may_push_out>("may_push_out", "Nine-ball, ten-ball: the shot after the break."),
               row<&State::fouls>("fouls", "In a row; snooker: misses with a clear path to a full ball.",
                                  {0, kMostPoints}),
               row<&State::on>("on", "Snooker: the ball on; colour: any, after a red."),
               row<&State::free_ball>("free_ball", "Snooker: any ball may be nominated."),
               row<&State::rules>("rules", "Options that are not defaults, such as \"call=eight\"."))
        .made_by_callers();
}
/// For readers of states: set_rule() for each of its rules. @throws std::invalid_argument
void complete(State& state);

/// A new game. @param first the player who begins @param target as in State::target; 0: the game's own, such
/// as 8 in free pyramid
State new_game(Game game, int first = 0, int target = 0);

struct RuleOption {
    Game game = &kEightBall;
    std::string key;
    std::vector<std::string> values;
    std::string what;
    bool operator==(const RuleOption&) const = default;
};
constexpr auto rows_of(const RuleOption*) {
    return described("RuleOption", "An option of a game's rules.",
                     row<&RuleOption::game>("game", "The game."), row<&RuleOption::key>("key", "Its name."),
                     row<&RuleOption::values>("values", "The first one is the default."),
                     row<&RuleOption::what>("what", "Its meaning."));
}

/// A game, without the functions of its rules.
struct GameInfo {
    std::string name, title{}, book{}, calls{};
    bool is_scored = true, has_groups = false, has_safety = false, has_push_out = false;
    int target = 0, usual_target = 0, balls = 15;
    std::string table = "nine_foot", start{};
    std::vector<RuleOption> options{};
    bool operator==(const GameInfo&) const = default;
};
constexpr auto rows_of(const GameInfo*) {
    return described(
        "GameInfo", "A game.", row<&GameInfo::name>("name", "In files."),
        row<&GameInfo::title>("title", "For people."),
        row<&GameInfo::book>("book", "Its published rules, with their edition."),
        row<&GameInfo::calls>("calls", "Announcements before a shot."),
        row<&GameInfo::is_scored>("is_scored", "Players collect points."),
        row<&GameInfo::has_groups>("has_groups", "Each player has a group of balls."),
        row<&GameInfo::has_safety>("has_safety", "A safety may be called."),
        row<&GameInfo::has_push_out>("has_push_out", "A push out may be called."),
        row<&GameInfo::target>("target", "Points that win, if none are given; 0: no end."),
        row<&GameInfo::usual_target>("usual_target", "A target to offer; 0: none."),
        row<&GameInfo::balls>("balls", "Object balls of a full rack."),
        row<&GameInfo::table>("table", "A table for it: a preset."),
        row<&GameInfo::start>(
            "start",
            "Its first scene, without table and balls. Places are fractions of the width (w) and "
            "the length (l) of the table; SEED is of the rack."),
        row<&GameInfo::options>("options", "Of its rules."));
}
const GameInfo& info_of(Game game);
std::vector<GameInfo> all_games();
/// Chooses an option of the state's game, such as "call=eight". @throws std::invalid_argument for an unknown
/// key or value; it lists the known ones
void set_rule(State& state, std::string_view option);

struct Call {
    std::string ball, pocket;
    bool safety = false;
    bool push_out = false;
    bool operator==(const Call&) const = default;
};
constexpr auto rows_of(const Call*) {
    return described(
               "Call", "An announcement before a shot.",
               row<&Call::ball>("ball",
                                "Id of the called ball. Snooker: the nominated colour or free ball; if \"\", "
                                "the ball that is hit first."),
               row<&Call::pocket>("pocket", "Id of the called pocket: \"p1\", ..."),
               row<&Call::safety>("safety",
                                  "Eight-ball, ten-ball, straight pool: the turn ends whatever falls."),
               row<&Call::push_out>("push_out", "Nine-ball, ten-ball: a push out."))
        .made_by_callers();
}

struct Legal {
    std::vector<std::string> cue_balls, first, callable;
    InHand in_hand = InHand::kNo;
    bool may_push_out = false;
    bool operator==(const Legal&) const = default;
};
constexpr auto rows_of(const Legal*) {
    return described("Legal", "The rules of the next shot.",
                     row<&Legal::cue_balls>("cue_balls", "That may be struck: one, in free pyramid any."),
                     row<&Legal::first>("first", "That may be hit first."),
                     row<&Legal::callable>("callable", "That may be called."),
                     row<&Legal::in_hand>("in_hand", "As in the state."),
                     row<&Legal::may_push_out>("may_push_out", "A push out may be called."));
}

/// @param balls ids of the balls on the table. The cue ball may be missing while it is in hand. Ids are those
/// of racks: cue, 1 to 15; white, yellow, red (four-ball: red1, red2); snooker numbers its reds. @throws
/// std::invalid_argument if no ball is left to play
Legal legal(const State& state, std::span<const std::string> balls);
/// The same for the balls of a scene. While the cue ball is in hand behind the head string, a ball behind it
/// is not in `first`, unless all of them are there: the cue ball must cross the string before it hits one.
Legal legal(const State& state, const Scene& scene);

enum class Foul : std::uint8_t {
    kCueBallPocketed,
    kCueBallOff,
    kNoBallHit,
    kWrongBallFirst,
    kNoCushion,  ///< nothing fell, and no ball hit a cushion after the first contact
    kFewCushionsOnBreak,
    kBallOff,
    kPlacedOutside,     ///< the cue ball was in hand and placed outside its area
    kBehindHeadString,  ///< it hit a ball behind the head string before crossing it
    kThirdFoul,
    kWrongCueBall,
    kOpeningNotRed,
    kWrongBallPocketed,
    kTwoBallsAtOnce,
    kJumpShot,           ///< the cue ball passed over a ball before it hit one
    kBehindTheFreeBall,  ///< the nominated free ball snookers the other player
    kMiss,               ///< snooker: no ball on was hit first, although a straight path to one was clear
    kOpponentsBall,      ///< four-ball: the cue ball hit the other player's
    kIntoTouchingBall,   ///< carom games: the cue ball was driven into a ball that it touched
};
constexpr auto names_of(Foul) {
    return std::array{"cue ball pocketed",
                      "cue ball off the table",
                      "no ball hit",
                      "wrong ball first",
                      "no cushion after contact",
                      "too few balls to a cushion on the break",
                      "ball off the table",
                      "cue ball placed outside its area",
                      "ball behind the head string first",
                      "third foul in a row",
                      "wrong cue ball",
                      "opening shot not at the red",
                      "wrong ball pocketed",
                      "two balls hit at once",
                      "jump shot",
                      "snooker behind the free ball",
                      "miss",
                      "opponent's cue ball hit",
                      "touching ball played into"};
}

struct CalledFoul {
    Foul foul = Foul::kNoBallHit;
    std::string rule{};
    bool operator==(const CalledFoul&) const = default;
};
constexpr auto rows_of(const CalledFoul*) {
    return described("Foul", "A foul, and the rule that it breaks.",
                     row<&CalledFoul::foul>("foul", "Its name."),
                     row<&CalledFoul::rule>("rule", "\"WPA 6.1\"; \"\" if the game has no such rule."));
}

struct Respot {
    std::string ball;
    Vec2 place = Vec2::Zero();
    bool operator==(const Respot&) const = default;
};
constexpr auto rows_of(const Respot*) {
    return described("Respot", "A ball that is respotted.", row<&Respot::ball>("ball", "Its id.").needed(),
                     row<&Respot::place>("place", "[m]").needed());
}

/// The next shot in words: "player 2 shoots, cue ball in hand anywhere".
std::string next_text(const State& state);

/// How the game may continue.
enum class Decision : std::uint8_t {
    kPlayOn,          ///< the balls stay
    kTakeInHand,      ///< the cue ball is in hand
    kPassBack,        ///< the other player shoots
    kRerack,          ///< the chooser breaks again
    kRerackForOther,  ///< the other player breaks again
    kSpotEight,       ///< the eight is respotted, and play continues
    kSpotTouching,    ///< carom games: the cue ball and the balls touching it are spotted
    kReplace,         ///< snooker: the balls return to where they were, and the same player shoots
    kRackFourteen,    ///< straight pool: the pocketed balls are racked at the places in respots
};
constexpr auto names_of(Decision) {
    return std::array{"play on",          "take in hand",   "pass back",           "rerack",
                      "rerack for other", "spot the eight", "spot touching balls", "replace the balls",
                      "rack fourteen"};
}

struct Option {
    Decision decision = Decision::kPlayOn;
    State state;
    std::vector<Respot> respots;
    std::string record{};
    bool rerack() const { return decision == Decision::kRerack || decision == Decision::kRerackForOther; }
    std::string text() const { return next_text(state); }
    bool operator==(const Option&) const = default;
};
constexpr auto rows_of(const Option*) {
    return described("Option", "A possible continuation of the game.",
                     row<&Option::decision>("decision", "The next step."),
                     row<&Option::state>("state", "Of the next shot."),
                     row<&Option::respots>("respots", "Before it."),
                     row<&Option::rerack>("rerack", "The balls are racked again."),
                     row<&Option::text>("text", "The next shot in words."),
                     row<&Option::record>("record", "Hash of the judged record; \"\": unknown."));
}

struct Verdict {
    std::vector<CalledFoul> fouls;
    int points = 0;
    int penalty = 0;
    std::vector<Option> options;
    int chooser = -1;
    const State& next() const { return options.front().state; }
    const std::vector<Respot>& respots() const { return options.front().respots; }
    bool operator==(const Verdict&) const = default;
};
constexpr auto rows_of(const Verdict*) {
    return described("Verdict", "The outcome of a shot.",
                     row<&Verdict::fouls>("fouls", "Empty for a fair shot."),
                     row<&Verdict::points>("points", "Scored by the shot."),
                     row<&Verdict::penalty>("penalty", "Snooker: points for the other player."),
                     row<&Verdict::options>(
                         "options", "At least one; the first applies unless the chooser picks another."),
                     row<&Verdict::chooser>("chooser", "A player; -1 with one option, or if lots decide."));
}

/// The outcome of a shot. @param state before it
/// @throws std::invalid_argument for a record that does not end at rest, has no cue strike or lacks the
/// game's balls, for a call of a ball or pocket that is not there or of a push out in another game, and for
/// a game that is over
Verdict judge(const State& state, const Record& record, const Call& call = {});
/// Sets Option::record, for verdicts that are kept: functions below refuse their options with other records.
void name_record(Verdict& verdict, const Record& record);

/// The ball that the player to shoot strikes: "cue", or in carom games "white" or "yellow". In free pyramid
/// any ball may be struck.
const char* cue_ball(const State& state);
/// As cue_ball(), or in free pyramid another ball if it is gone. @param balls as in legal()
std::string struck_next(const State& state, std::span<const std::string> balls);

/// Whether the cue ball may be placed there before the next shot: it is in hand there, lies on the table
/// between the noses, and overlaps no ball. @param record of the previous shot
/// @throws std::invalid_argument for an option with balls that are not in the record
bool may_place(const Record& record, const Option& option, const Vec2& place);

/// The place nearest to `wanted`, by default the head spot, that may_place() allows, in steps of a quarter of
/// the ball's radius.
/// @throws std::invalid_argument as may_place(), and if there is none
Vec2 free_place(const Record& record, const Option& option, const std::optional<Vec2>& wanted = {});

/// The table before the next shot, without a cue: pocketed balls are gone, respotted balls are back, and the
/// cue ball is placed.
/// @param scene of the record
/// @param option of the verdict, except one that racks again
/// @param place of the cue ball: required if it is gone, allowed if it is in hand
/// @throws std::invalid_argument for a place that is missing or not allowed (may_place), for a new rack, for
/// a game that is over, and for an option or a scene with other balls than the record
Scene table_after(const Scene& scene, const Record& record, const Option& option,
                  const std::optional<Vec2>& place = std::nullopt);

/// The next shot: table_after() with the strike, validated. @throws SceneError if the scene is not valid
Scene next_scene(const Scene& scene, const Record& record, const Option& option, const Cue& cue,
                 const std::optional<Vec2>& place = std::nullopt);

}  // namespace carom::games
