#include "commands/solve/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/console.h"
#include "base/output_file.h"
#include "base/setup.h"
#include "base/statistics.h"
#include "carom/engine/batch.h"
#include "carom/engine/printable.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;
using games::Choice;
using games::Solution;

std::string pocket_of(const Scene& scene, int pocket) {
    return scene.table.pockets[static_cast<std::size_t>(pocket)].id;
}

Json as_json(const Solution& solution, const std::vector<Choice>& choices) {
    const Share share = share_of(solution.successes, solution.shots);
    Json values = Json::object(), falls = Json::array(), costs = Json::array();
    for (std::size_t k = 0; k < choices.size(); ++k) values[choices[k].key] = solution.values[k];
    for (const Solution::Fall& fall : solution.falls)
        falls.push_back({{"ball", solution.scene.ball[static_cast<std::size_t>(fall.ball)].id},
                         {"pocket", pocket_of(solution.scene, fall.pocket)},
                         {"per_shot", fall.share}});
    for (const Solution::Cost& cost : solution.costs)
        costs.push_back({{"input", cost.input},
                         {"off_by", cost.by},
                         {"unit", cost.unit},
                         {"success", {cost.less, cost.more}}});
    return {{"success", share.value},
            {"interval", {share.low, share.high}},
            {"shots", solution.shots},
            {"values", values},
            {"falls", falls},
            {"costs", costs},
            {"scene", scene_text(solution.scene)}};
}

}  // namespace

void add_search(Options& command, SearchArgs& args) {
    command.option(
        "--hand", &args.hand, "ERRORS",
        "Standard deviations: aim in degrees, speed in percent, tip in ball radii, elevation in degrees");
    command.option("--shots", &args.shots, "N", "How many shots the search plays").in(1000, 1e10);
    command.option("--best", &args.best, "N", "How many shots of different kinds are shown").in(1, 20);
    command.option("--seed", &args.seed, "S", "Seed of the search");
    command.option("--jobs", &args.jobs, "J", "Threads; 0: one per core; the result does not depend on it")
        .in(0, 256);
    command.option("-o,--output", &args.output, "FILE.toml",
                   "Write the best shot as a scene (default: not written)");
    command.flag("--json", args.json, "Print everything as JSON (default: off)");
}

std::vector<Solution> search(const Scene& scene, const std::string& name, const std::string& want,
                             std::optional<games::Game> game, std::vector<Choice> choices,
                             std::vector<Scene> layouts, const SearchArgs& args,
                             std::vector<games::Exact>* exact) {
    games::SolveOptions options;
    options.choices = std::move(choices);
    options.layouts = std::move(layouts);
    options.hand = read_hand(args.hand);
    options.seed = args.seed;
    options.shots = static_cast<std::size_t>(args.shots);
    options.threads = args.jobs;
    options.best = static_cast<std::size_t>(args.best);
    ProgressLine line("search");
    options.progress = [&](std::size_t done) {
        line.show_bar(static_cast<long>(done), static_cast<long>(options.shots));
    };
    options.stop = [] { return interrupted(); };
    try {
        const games::Measure wanted(want, scene, game);
        if (exact != nullptr && wanted.places().empty())
            throw UsageError(
                "--exact: no place is wanted; add one, as in --want 'cue near (0.6, 1.2, 0.05)'");
        std::vector<Solution> found = games::solve(scene, wanted, chosen_isa(), options);
        for (std::size_t i = 0; exact != nullptr && i < found.size(); ++i)
            exact->push_back(games::exact(found[i], wanted, chosen_isa(), options));
        return found;
    } catch (const games::MeasureError& error) {
        throw UsageError(fmt::format("--want {}", error.what()));
    } catch (const BatchStopped&) {
        throw Interrupted();
    } catch (const std::invalid_argument& error) {
        throw UsageError(fmt::format("{}: {}", harmless(name), error.what()));
    }
}

std::string falls_text(const Solution& solution) {
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(6, solution.falls.size()); ++i) {
        const Solution::Fall& fall = solution.falls[i];
        if (fall.share < 0.02) break;
        text += fmt::format("{}{} into {} {:.0f} %", i == 0 ? "   falls " : ", ",
                            solution.scene.ball[static_cast<std::size_t>(fall.ball)].id,
                            pocket_of(solution.scene, fall.pocket), 100.0 * fall.share);
    }
    return text.empty() ? "" : text + "\n";
}

std::string costs_text(const Solution& solution) {
    std::string text;
    for (const Solution::Cost& cost : solution.costs)
        text += fmt::format("   {} off by {:.3g} {}: {:.0f} % or {:.0f} %\n", cost.input, cost.by, cost.unit,
                            100.0 * cost.less, 100.0 * cost.more);
    return text;
}

Json solutions_json(const std::vector<Solution>& solutions, const std::vector<Choice>& choices) {
    Json all = Json::array();
    for (const Solution& solution : solutions) all.push_back(as_json(solution, choices));
    return all;
}

void write_best(const std::string& path, const Solution& best, const std::string& want,
                const SearchArgs& args) {
    OutputFile file(path);
    file.write(fmt::format("# Found by carom for: {}\n# Success with a hand of {}: {}\n{}", harmless(want),
                           args.hand, share_text(share_of(best.successes, best.shots)),
                           scene_text(best.scene)));
    file.commit();
}

}  // namespace carom::tools
