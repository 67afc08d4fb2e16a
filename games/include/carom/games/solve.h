// Finds the shot most likely to achieve a goal, given the errors of a hand.
//
// Every candidate is played with the same errors and the same layouts of the balls (common random numbers),
// so that candidates differ in merit and not in luck. Most are dropped after a few shots, and the rest get
// more (successive halving: Jamieson and Talwalkar, "Non-stochastic best arm identification and
// hyperparameter optimization", AISTATS 2016). The best then have descendants nearby for several generations,
// and more shots decide among the last generation. The reported figures come from shots that the search has
// not used.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/row.h"
#include "carom/engine/scene.h"
#include "carom/games/measures.h"
#include "carom/kernel/isa.h"

namespace carom::games {

struct Hand {
    double aim_deg = 0.2, speed = 0.03, tip = 0.02, elevation_deg = 0.0;
    bool operator==(const Hand&) const = default;
};
constexpr auto rows_of(const Hand*) {
    return described("Hand", "Standard deviations of a player's independent normal errors.",
                     row<&Hand::aim_deg>("aim_deg", "Of the aim [degrees]."),
                     row<&Hand::speed>("speed", "Of the cue's speed, as a fraction of it."),
                     row<&Hand::tip>("tip", "Of the tip, sideways and up [ball radii]."),
                     row<&Hand::elevation_deg>("elevation_deg", "Of the elevation [degrees]."))
        .made_by_callers();
}

struct Unknown {
    double cloth = 0.05, rails = 0.02, places = 1e-4, gaps = 2e-5;
    bool operator==(const Unknown&) const = default;
};
constexpr auto rows_of(const Unknown*) {
    return described("Unknown",
                     "Standard deviations of a table's properties that a player does not know, drawn anew "
                     "for every "
                     "trial; all 0 for exact tables.",
                     row<&Unknown::cloth>("cloth", "Of mu_s and of mu_r, as a fraction."),
                     row<&Unknown::rails>("rails", "Of the restitution of the cushions, as a fraction."),
                     row<&Unknown::places>("places", "Of every ball along x and y, except racked ones [m]."),
                     row<&Unknown::gaps>("gaps", "Between racked balls [m]."))
        .made_by_callers();
}
inline constexpr Unknown kExactTable{0.0, 0.0, 0.0, 0.0};

/// The key of a choice that sets the speed of the struck ball instead of the cue's [m/s].
inline constexpr const char* kBallSpeed = "cue.ball_speed";

/// An input that the search chooses.
struct Choice {
    /// As SceneNumber accepts it; or hit.BALL, which aims at that ball: 0 is full, 1 and -1 pass its left and
    /// right edge, without allowance for squirt; or kBallSpeed.
    std::string key;
    double low = 0.0, high = 0.0;
};

/// Aim, speed and height of the tip.
std::vector<Choice> default_choices();

/// Scene number i, which differs from the others only in the places and sizes of its balls; or empty.
using Racks = std::function<Scene(std::uint64_t)>;

struct SolveOptions {
    std::vector<Choice> choices;
    Hand hand;
    Unknown unknown;
    std::uint64_t seed = 1;
    std::size_t shots = 200000;  ///< of the whole search
    int threads = 0;             ///< 0: one for each core
    std::size_t best = 3;        ///< number of shots of different kinds
    Racks racks;
    std::function<void(std::size_t done)> progress;
    std::function<bool()> stop;
};

/// A share of shots, and its interval: 95 of 100 such intervals contain the true share (Wilson, 1927).
struct Share {
    double value = 0.0, low = 0.0, high = 0.0;
    bool operator==(const Share&) const = default;
};
constexpr auto rows_of(const Share*) {
    return described("Share",
                     "A share of shots, with an interval that contains the true one 95 times in 100.",
                     row<&Share::value>("value", "0 to 1."), row<&Share::low>("low", "Of the interval."),
                     row<&Share::high>("high", "Of the interval."));
}
Share share_of(std::size_t part, std::size_t whole);
/// The interval of a share of this number of shots.
Share with_interval(double share, std::size_t shots);

struct Fall {
    std::string ball, pocket;
    double share = 0.0;
};
constexpr auto rows_of(const Fall*) {
    return described("Fall", "How often a ball falls into a pocket.", row<&Fall::ball>("ball", "Its id."),
                     row<&Fall::pocket>("pocket", "Its id."),
                     row<&Fall::share>("share", "Of the shots of the solution."));
}

struct Cost {
    std::string input;
    double by = 0.0;
    std::string unit;
    double less = 0.0, more = 0.0;
    int shots = 0;
};
constexpr auto rows_of(const Cost*) {
    return described("Cost", "The success if one input is off.",
                     row<&Cost::input>("input", "Its key, or aim."), row<&Cost::by>("by", "The error."),
                     row<&Cost::unit>("unit", "Of the error."),
                     row<&Cost::less>("less", "Share of successes; NaN if no scene is valid there.").or_nan(),
                     row<&Cost::more>("more", "The same in the other direction.").or_nan(),
                     row<&Cost::shots>("shots", "In each direction."));
}

struct Solution {
    std::vector<double> values;  ///< in the order of the choices
    Scene scene;                 ///< the shot without errors
    std::size_t shots = 0, successes = 0;
    std::size_t exact = 0;    ///< successes of as many shots on exact tables (kExactTable)
    std::vector<Fall> falls;  ///< the most frequent first
    std::vector<Cost> costs;
};

/// Success around a solution, over the two choices that require the most precision.
struct SuccessMap {
    std::array<std::size_t, 2> choices{};
    struct Cell {
        std::array<double, 2> place;  ///< the values of the two choices
        double success;
    };
    std::vector<Cell> cells;  ///< an even grid
};

/// A choice requires more precision, the smaller the fraction of its range by which success halves.
/// @throws std::invalid_argument as solve, and if there are fewer than two choices
SuccessMap success_map(const Scene& scene, const Measure& want, kernel::Isa isa, const SolveOptions& options,
                       const Solution& around);

/// The best shots of different kinds, the surest first. Two searches begin at other places with half of the
/// shots each; from the fourth generation on, the best of both are searched together.
/// @param starts  if not null, receives the success of the best of each search before that: far apart, they
/// warn that there may be a better shot
/// @throws std::invalid_argument for a key that names no number, an invalid range, or a goal that does not
/// apply to the shots
std::vector<Solution> solve(const Scene& scene, const Measure& want, kernel::Isa isa,
                            const SolveOptions& options, std::vector<double>* starts = nullptr);

}  // namespace carom::games
