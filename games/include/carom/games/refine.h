// Moves a shot until its balls come to rest at given places: Newton's method on the derivatives of the shot
// (carom/engine/derivatives.h), with minimum-norm steps that are halved until they help.
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
    double miss = 0.0;           ///< [m] largest distance of a ball from its place
    int shots = 0;               ///< tried; derivatives need more
    std::string trouble;         ///< why it stopped there; "" if `miss` is at most kRefined
};
inline constexpr double kRefined = 1e-6;  ///< [m]

/// @param choices  numbers of the scene, and the ranges to which the shot is kept; steps are measured in
/// fractions of the ranges
/// @param allowed  must hold after every step; null: no condition
/// @throws std::invalid_argument for a choice that is no number of the scene
Refined refine(const Scene& scene, std::span<const Choice> choices, std::span<const Place> places,
               kernel::Isa isa, const std::function<bool(const Record&)>& allowed = {});

/// A shot of a search, moved until the balls rest at the centre of every `near`, and its success rate.
struct Exact {
    Refined refined;
    std::vector<Choice> choices;       ///< of the search, with cue.aim_deg for an aim at a ball
    std::optional<Solution> solution;  ///< empty if there is no exact shot nearby
};
/// @param options  of the search; a tenth of its shots gives the success rate of the result
/// @throws std::invalid_argument if the goal has no `near`; as solve()
Exact exact(const Solution& found, const Measure& want, kernel::Isa isa, const SolveOptions& options);

}  // namespace carom::games
