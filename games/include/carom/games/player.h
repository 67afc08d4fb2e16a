// A player of pool: the best shot of a position, how sure it is, and what to choose where the rules offer a
// choice. Eight-ball, nine-ball and ten-ball.
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
    kPot,    ///< the surest pot, and not what it leaves
    kQuick,  ///< also what it leaves, in about 1700 simulated shots
    kWhole,  ///< the same for more spins and speeds, in about 4000
};
constexpr auto names_of(Look) {
    return std::array{"pot", "quick", "whole"};
}

/// How well a player strikes, and how much it looks at.
struct Skill {
    Noise noise;
    Look look = Look::kWhole;
    double of_speed = 0.0;  ///< [-] another error of the speed, in parts of it
    /// Of a strike with this speed [m/s].
    Noise noise_at(double speed) const;
    bool operator==(const Skill&) const = default;
};
inline constexpr std::array kSkills{"beginner", "club", "league", "professional", "machine"};
/// The level of that name: 4, 2, 1, 1 and 1/2 times the noise "fastfiz". @param R radius of the cue ball [m]
/// @throws std::invalid_argument for another name, or a radius that is not greater than 0
Skill skill_by_name(std::string_view name, double R);

enum class ShotKind : std::uint8_t { kPot, kCombination, kBank, kKick, kSafety, kPushOut, kBreak };
constexpr auto names_of(ShotKind) {
    return std::array{"pot", "combination", "bank", "kick", "safety", "push out", "break"};
}

struct Advice {
    Cue cue;
    Call call;
    std::optional<Vec2> place;  ///< of the cue ball, if it is in hand [m]
    ShotKind kind = ShotKind::kPot;
    std::string ball, pocket;  ///< what it pots: ids; "" for other kinds
    double cut_deg = 0.0;      ///< of a pot: how far the object ball turns to the left [degrees]
    /// From AdviceOptions::fresh shots that the search has not seen: how often the turn or the game is won,
    /// and how often the shot is a foul. All shots of a break are fresh.
    Share makes{}, fouls{};
    double worth = 0.0;               ///< mean value of what the shot leaves: 1 is a game won, 0 one lost [-]
    std::vector<std::string> leaves;  ///< the balls that it most often leaves as the surest pot, at most 3
};

struct AdviceOptions {
    std::uint64_t seed = 1;  ///< of the errors
    int threads = 1;         ///< the result does not depend on it
    std::size_t best = 3;    ///< the most pieces of advice
    /// shots that check each of them; 0: none, and Advice::makes is that of the search
    std::size_t fresh = 400;
    std::function<bool()> stop{};  ///< true ends the search with BatchStopped
};

/// The best shots that differ in kind, ball or pocket, the best first; at least one.
/// @param scene  the balls, which lie still; of its cue, only the kind counts. The cue ball may be missing
/// while it is in hand. For a break, the rack.
/// @throws std::invalid_argument for a game without a player, a game that is over, and a state that does not
/// fit the scene
std::vector<Advice> advise(const State& state, const Scene& scene, const Skill& skill, kernel::Isa isa,
                           const AdviceOptions& options = {});

/// The scene of an advised shot: with its cue, and the cue ball where it is placed.
Scene scene_with(const Scene& scene, const Advice& advice);

/// The index of the option that is best for the player who may choose. @param record of the judged shot
/// @throws std::invalid_argument for a game without a player
std::size_t choose(const Verdict& verdict, const Record& record, const Skill& skill);

/// A sentence such as "the 7 into p3 (right side), cut 23 degrees to the left, medium, low".
std::string words_of(const Advice& advice, const Table& table);

}  // namespace carom::games
