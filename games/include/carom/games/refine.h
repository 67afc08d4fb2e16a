// Moves a shot until its balls come to rest at given places: Newton's method on the derivatives of the shot
// (carom/engine/tangents.h), with steps of least size that are halved until they help.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "carom/engine/scene.h"
#include "carom/games/measures.h"
#include "carom/games/solve.h"

namespace carom::games {

struct Refined {
    std::vector<double> values;  ///< in the order of the choices
    Scene scene;                 ///< with these values
    double miss = 0.0;           ///< [m] of the ball that is farthest from its place
    int shots = 0;               ///< simulated
    std::string trouble;         ///< why it is no nearer; "" if `miss` is at most kRefined
};
inline constexpr double kRefined = 1e-6;  ///< [m]

/// @param choices  numbers of the scene, and their ranges, which the shot does not leave; steps are measured
/// in parts of the ranges
/// @param allowed  what every step must keep true; null: nothing
/// @throws std::invalid_argument for a choice that is no number of the scene
Refined refine(const Scene& scene, std::span<const Choice> choices, std::span<const Place> places,
               kernel::Isa isa, const std::function<bool(const Record&)>& allowed = {});

/// A shot of a search that was moved until the balls rest at the centre of every `near`, and how sure it is.
struct Exact {
    Refined refined;
    std::vector<Choice> choices;       ///< those of the search, with cue.aim_deg for an aim at a ball
    std::optional<Solution> solution;  ///< nothing if there is no exact shot near
};
/// @param options  those of the search; a tenth of its shots gives the success rate of the result
/// @throws std::invalid_argument if nothing has to be near a place; as solve()
Exact exact(const Solution& found, const Measure& want, kernel::Isa isa, const SolveOptions& options);

}  // namespace carom::games
