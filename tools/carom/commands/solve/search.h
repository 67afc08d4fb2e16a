// Shared by carom solve and carom break: the hand, the racks, the search with its progress.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/hand.h"
#include "base/options.h"
#include "carom/games/refine.h"
#include "carom/games/solve.h"

namespace carom::tools {

/// The options of a search.
struct SearchArgs {
    std::string hand = kHand, unknown = kUnknown, output, plot;
    std::uint64_t shots = games::SolveOptions().shots, seed = 1;
    int jobs = 0, best = 3;
    bool json = false;
};
void add_search(Options& command, SearchArgs& args);

/// The search space.
struct Search {
    const Scene& scene;
    std::string name;  ///< of the scene, for messages
    std::string want;
    std::optional<games::Game> game;
    std::vector<games::Choice> choices;
    games::Racks racks;
};
/// Searches with a progress bar. @param starts  receives the success of the best of each search, as solve()
/// @param exact  if not null, the found shots are refined, and the results are stored there
/// @throws UsageError, Interrupted
std::vector<games::Solution> search(const Search& what, const SearchArgs& args, std::vector<double>& starts,
                                    std::vector<games::Exact>* exact = nullptr);

/// Writes the picture requested by args.plot: the shot, and success over its two strongest inputs.
void plot_best(const Search& what, const games::Solution& best, const std::string& title,
               const SearchArgs& args);

/// The lines on the drawn properties, and on how far apart the searches were.
std::string lead_text(const SearchArgs& args, const std::vector<double>& starts);
/// "77.40 %  (76.32 to 78.44)  of 6000 shots", and the rate on exact tables.
std::string rates_text(const games::Solution& solution, const char* what, const SearchArgs& args);

/// "falls 1 into p5 49 %, ..." and the costs of errors, a line each.
std::string falls_text(const games::Solution& solution);
std::string costs_text(const games::Solution& solution);
nlohmann::ordered_json solutions_json(const std::vector<games::Solution>& solutions,
                                      const std::vector<games::Choice>& choices);

/// Writes the best shot as a scene with comments on the search.
void write_best(const std::string& path, const games::Solution& best, const std::string& want,
                const SearchArgs& args);

}  // namespace carom::tools
