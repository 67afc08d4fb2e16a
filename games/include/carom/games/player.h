// A player of pool: the best shot of a position, its success rate, and the choice among the options of the
// rules. Eight-ball, nine-ball and ten-ball.
//
// The search samples noisy shots of candidates and values the positions that they leave, one shot deep, after
// Smith, "PickPocket: A computer billiards shark", Artificial Intelligence 171 (2007).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "carom/games/noise.h"
#include "carom/games/rules.h"
#include "carom/games/solve.h"

namespace carom::games {

/// The options of a player before a shot.
enum class Look : std::uint8_t {
    kPot,    ///< the surest pot, regardless of the position that it leaves
    kQuick,  ///< also the position that it leaves, in about 1700 simulated shots
    kWhole,  ///< the same for more spins and speeds, in about 4000
};
constexpr auto names_of(Look) {
    return std::array{"pot", "quick", "whole"};
}

/// The level of a player: the size of its errors and the depth of its search.
struct Skill {
    Noise noise;
    Look look = Look::kWhole;
    double of_speed = 0.0;          ///< [-] another error of the speed, as a fraction of it
    Unknown unknown = kExactTable;  ///< properties of the table that the player does not know
    /// Of a strike with this speed [m/s].
    Noise noise_at(double speed) const;
    bool operator==(const Skill&) const = default;
};
inline constexpr std::array kSkills{"beginner", "club", "league", "professional", "machine"};
/// The named level: 4, 2, 1, 1 and 1/2 times the noise "fastfiz"; none knows the cloth better than to 5 %,
/// the rails to 2 % and the places of balls to 0.2 mm. @param R radius of the cue ball [m]
/// @throws std::invalid_argument for another name, or a radius that is not greater than 0
Skill skill_by_name(std::string_view name, double R);

enum class ShotKind : std::uint8_t { kPot, kCombination, kBank, kKick, kSafety, kPushOut, kBreak };
constexpr auto names_of(ShotKind) {
    return std::array{"pot", "combination", "bank", "kick", "safety", "push out", "break"};
}

struct Advice {
    std::string words, result;
    ShotKind kind = ShotKind::kPot;
    std::string ball, pocket;
    double cut_deg = 0.0;
    Cue cue, strike;
    Call call;
    std::optional<Vec2> place;
    Share makes, fouls;
    double worth = 0.0;
    std::vector<std::string> leaves;
    bool operator==(const Advice&) const = default;
};
constexpr auto rows_of(const Advice*) {
    return described(
        "Advice", "A shot to play, and its success rate.",
        row<&Advice::words>(
            "words", "The shot: \"7 into p5 (right side pocket), half ball to the left, stun, medium\"."),
        row<&Advice::result>("result", "Its result: \"pots 84 % (80 to 87), wins 61 %, fouls 2 %; ...\"."),
        row<&Advice::kind>("kind", "Its kind."),
        row<&Advice::ball>("ball", "The ball that it pots; \"\" for other kinds."),
        row<&Advice::pocket>("pocket", "The pocket of that ball."),
        row<&Advice::cut_deg>("cut_deg", "Of a pot: how far the object ball turns to the left."),
        row<&Advice::cue>("cue", "The strike."),
        row<&Advice::strike>("strike", "With random errors of the level."),
        row<&Advice::call>("call", "For the judge."),
        row<&Advice::place>("place", "Of the cue ball in hand [m]."),
        row<&Advice::makes>("makes", "Of shots that the search has not used: it wins the turn or the game."),
        row<&Advice::fouls>("fouls", "Of these shots: it is a foul."),
        row<&Advice::worth>("worth",
                            "Mean chance to win the rack against a player of the same level, as estimated; "
                            "in eight-ball only an order."),
        row<&Advice::leaves>("leaves", "The balls that it most often leaves as the surest pot, at most 3."));
}

struct AdviceOptions {
    std::uint64_t seed = 1;  ///< of the errors
    int threads = 1;         ///< the result does not depend on it
    std::size_t best = 3;    ///< largest number of shots advised
    /// fresh shots for each; 0: none, and Advice::makes comes from the search
    std::size_t fresh = 400;
    std::function<bool()> stop{};  ///< true ends the search with BatchStopped
};

/// The best shots of different kind, ball or pocket, the best first; at least one.
/// @param scene  the balls, at rest; of its cue, only the kind counts. The cue ball may be missing while it
/// is in hand. For a break, the rack.
/// @throws std::invalid_argument for a game without a player, a game that is over, and a state that does not
/// fit the scene
std::vector<Advice> advise(const State& state, const Scene& scene, const Skill& skill, kernel::Isa isa,
                           const AdviceOptions& options = {});

/// The scene of an advised shot, with its cue and the placed cue ball.
Scene scene_with(const Scene& scene, const Advice& advice);

/// The index of the best option for the player who chooses. @param record of the judged shot
/// @throws std::invalid_argument for a game without a player
std::size_t choose(const Verdict& verdict, const Record& record, const Skill& skill);

}  // namespace carom::games
