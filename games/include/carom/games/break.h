// The search for a break: where the cue ball lies, how full and how hard it hits, and how sure that is.
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
/// [m] Between neighbours in a rack: a template presses the balls together, a triangle leaves them about this
/// far apart.
inline constexpr double kTemplateGap = 0.0, kTriangleGap = 5e-5, kLargestGap = 0.001;

struct BreakOptions {
    std::string game = kBreakGames[0];
    std::string table = kStandardTable;
    double gap = kTemplateGap;
    double speed_max = 10.0;  ///< the hardest that the player hits: speed of the cue ball [m/s], 1 to 20
    bool box = false;         ///< the cue ball at least a diamond from either long rail
    std::uint64_t seed = 1;   ///< of the racks
    int layouts = 64;         ///< racks that the break must cope with
};

/// What solve() is asked.
struct BreakSearch {
    Scene scene;
    std::string want;
    std::optional<Game> game;
    /// Position of the cue ball, x and y; hit.1; cue.speed; height of the tip.
    std::vector<Choice> choices;
    std::vector<Scene> layouts;
    double ball_speed = 0.0;  ///< of the cue ball, for each m/s of the cue [-]
};

/// @throws std::invalid_argument for a game or number that is not allowed; SceneError for another table
BreakSearch break_search(const BreakOptions& options, kernel::Isa isa);

/// The scene of a file with its rack as it comes out each time; empty if it has no rack. @throws SceneError
std::vector<Scene> racks_of(const std::string& text, const std::string& name, int count, std::uint64_t seed);

}  // namespace carom::games
