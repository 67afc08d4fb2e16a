// The search for a break: cue-ball position, cut and speed, and the success rate.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "carom/games/solve.h"

namespace carom::games {

inline constexpr std::array kBreakGames{"nine_ball", "ten_ball", "eight_ball"};
/// The ball at the front of these racks.
inline constexpr const char* kBreakApex = "1";
/// [m] Largest gap between neighbours in a rack.
inline constexpr double kLargestGap = 0.001;

struct BreakOptions {
    std::string game = kBreakGames[0];
    std::string table = kStandardTable;
    /// "template", "triangle" or "gap=METRES": the distance between neighbours, with a jitter of half of it.
    std::string rack = "template";
    double radius_sd = 0.0;   ///< of the racked balls [m]
    double speed_max = 10.0;  ///< maximum speed of the cue ball [m/s], 1 to 20
    bool box = false;         ///< place the cue ball at least a diamond from either long rail
    std::uint64_t seed = 1;   ///< of the racks
};

/// The arguments of solve().
struct BreakSearch {
    Scene scene;
    std::string want;
    std::optional<Game> game;
    /// Position of the cue ball, x and y; hit.1; cue.speed; height of the tip.
    std::vector<Choice> choices;
    Racks racks;              ///< one for each trial
    double ball_speed = 0.0;  ///< of the cue ball, for each m/s of the cue [-]
};

/// @throws std::invalid_argument for a game or number that is not allowed; SceneError for another table
BreakSearch break_search(const BreakOptions& options);

/// The scene of a file with other seeds of its rack; empty if it has no rack.
/// @param count  after this many racks the first one comes again; 0: all differ; 1: the rack of the file
/// @throws SceneError
Racks racks_of(const std::string& text, const std::string& name, int count, std::uint64_t seed);

}  // namespace carom::games
