#include "commands/solve/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "base/console.h"
#include "base/setup.h"
#include "base/statistics.h"
#include "carom/engine/batch.h"
#include "carom/engine/plan.h"
#include "carom/engine/printable.h"
#include "carom/engine/simulate.h"
#include "carom/interface/shape.h"
#include "report/sweep_plot.h"
#include "report/table.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;
using games::Choice;
using games::Solution;

}  // namespace

void add_search(Options& command, SearchArgs& args) {
    command.option("--hand", &args.hand, "ERRORS",
                   "Standard deviations of the player's errors: aim in degrees, speed in percent, tip in "
                   "ball radii, elevation in degrees");
    command.option(
        "--unknown", &args.unknown, "ERRORS",
        "Standard deviations of the unknown: cloth and rails in percent, places in mm, gaps of a rack in "
        "micrometres; or none, for exact tables");
    command.option("--shots", &args.shots, "N", "Number of shots that the search plays").in(1000, 1e10);
    command.option("--best", &args.best, "N", "Number of shots of different kinds to print").in(1, 20);
    command.option("--seed", &args.seed, "S", "Seed of the search");
    command.option("--jobs", &args.jobs, "J", "Threads, 0 for one per core; the result is always the same")
        .in(0, 256);
    command.option("-o,--output", &args.output, "FILE.toml",
                   "Write the best shot as a scene (default: not written)");
    command.option("--plot", &args.plot, "FILE",
                   "Draw the best shot, and success over its two strongest inputs: .svg, .pdf or .png "
                   "(default: not drawn)");
    command.flag("--json", args.json, "Print everything as JSON (default: off)");
}

namespace {

/// Plays with a progress bar: `play` gets the arguments of games::solve.
template <class Play>
auto played(const Search& what, const SearchArgs& args, const char* title, Play&& play) {
    games::SolveOptions options;
    options.choices = what.choices;
    options.racks = what.racks;
    options.hand = read_hand(args.hand);
    options.unknown = read_unknown(args.unknown);
    options.seed = args.seed;
    options.shots = static_cast<std::size_t>(args.shots);
    options.threads = args.jobs;
    options.best = static_cast<std::size_t>(args.best);
    ProgressLine line(title);
    options.progress = [&](std::size_t done) {
        line.show_bar(static_cast<std::int64_t>(done), static_cast<std::int64_t>(options.shots));
    };
    options.stop = [] { return interrupted(); };
    try {
        return play(games::Measure(what.want, what.scene, what.game), options);
    } catch (const games::MeasureError& error) {
        throw UsageError(fmt::format("--want {}", error.what()));
    } catch (const BatchStopped&) {
        throw Interrupted();
    } catch (const std::invalid_argument& error) {
        throw UsageError(fmt::format("{}: {}", harmless(what.name), error.what()));
    }
}

}  // namespace

std::vector<Solution> search(const Search& what, const SearchArgs& args, std::vector<double>& starts,
                             std::vector<games::Exact>* exact) {
    if (!args.plot.empty()) {
        diagram_format(args.plot);
        if (what.choices.size() < 2) throw UsageError("--plot: a map needs two inputs; give two --vary");
    }
    return played(what, args, "search", [&](const games::Measure& want, const games::SolveOptions& options) {
        if (exact != nullptr && want.places().empty())
            throw UsageError(
                "--exact: the goal has no place; add one, as in --want 'cue near (0.6, 1.2, 0.05)'");
        std::vector<Solution> found = games::solve(what.scene, want, chosen_isa(), options, &starts);
        for (std::size_t i = 0; exact != nullptr && i < found.size(); ++i)
            exact->push_back(games::exact(found[i], want, chosen_isa(), options));
        return found;
    });
}

void plot_best(const Search& what, const Solution& best, const std::string& title, const SearchArgs& args) {
    if (args.plot.empty()) return;
    const games::SuccessMap map =
        played(what, args, "map", [&](const games::Measure& want, const games::SolveOptions& options) {
            return games::success_map(what.scene, want, chosen_isa(), options, best);
        });
    SweepPlot plot;
    plot.heading = "Success rate around the shot";
    plot.measure = "wanted: " + what.want;
    for (const std::size_t choice : map.choices) plot.axes.push_back(what.choices[choice].key);
    for (const games::SuccessMap::Cell& cell : map.cells) plot.shots.push_back({cell.place, cell.success});
    DiagramStyle style;
    style.diamond_numbers = true;
    const DiagramShot shot{title, simulate(make_plan(best.scene, chosen_isa())), best.scene.cue};
    write_report(args.plot, draw_plot(plot, diagram_format(args.plot), {shot}, style));
}

std::string lead_text(const SearchArgs& args, const std::vector<double>& starts) {
    std::string text =
        read_unknown(args.unknown) == games::kExactTable
            ? "unknown: nothing, exact tables\n"
            : fmt::format("unknown: {}; each shot draws it (standard deviations)\n", args.unknown);
    std::vector<std::string> rates;
    rates.reserve(starts.size());
    for (const double share : starts) rates.push_back(fmt::format("{:.0f}", 100.0 * share));
    return text +
           fmt::format("searches from {} places, on their own so far: {} %; there may be a better shot\n",
                       rates.size(), fmt::join(rates, " and "));
}

std::string rates_text(const Solution& solution, const char* what, const SearchArgs& args) {
    const std::string rate = fmt::format(
        "{}  of {}", share_text(share_of(solution.successes, solution.shots)), counted(solution.shots, what));
    if (read_unknown(args.unknown) == games::kExactTable) return rate + "\n";
    return fmt::format("{}; exact table: {}\n", rate, share_text(share_of(solution.exact, solution.shots)));
}

std::string falls_text(const Solution& solution) {
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(6, solution.falls.size()); ++i) {
        const games::Fall& fall = solution.falls[i];
        if (fall.share < 0.02) break;
        text += fmt::format("{}{} into {} {:.1f} %", i == 0 ? "   falls " : ", ", fall.ball, fall.pocket,
                            100.0 * fall.share);
    }
    return text.empty() ? "" : text + fmt::format("  of the same {}\n", counted(solution.shots, "shot"));
}

std::string costs_text(const Solution& solution) {
    const auto part = [](double success, int shots) {
        if (std::isnan(success)) return std::string("impossible");
        const Share share = games::with_interval(success, static_cast<std::size_t>(shots));
        return fmt::format("{:.0f} % ({:.0f} to {:.0f})", 100.0 * share.value, 100.0 * share.low,
                           100.0 * share.high);
    };
    std::string text;
    for (const games::Cost& cost : solution.costs)
        text += fmt::format("   {} off by {:.3g} {}: -: {}, +: {}; of {} each\n", cost.input, cost.by,
                            cost.unit, part(cost.less, cost.shots), part(cost.more, cost.shots),
                            counted(static_cast<std::size_t>(cost.shots), "shot"));
    return text;
}

Json solutions_json(const std::vector<Solution>& solutions, const std::vector<Choice>& choices) {
    Json all = Json::array();
    for (const Solution& solution : solutions) {
        const Share share = share_of(solution.successes, solution.shots);
        Json values = Json::object();
        for (std::size_t k = 0; k < choices.size(); ++k) values[choices[k].key] = solution.values[k];
        all.push_back({{"success", share.value},
                       {"interval", {share.low, share.high}},
                       {"shots", solution.shots},
                       {"values", values},
                       {"falls", interface::value_of(solution.falls)},
                       {"costs", interface::value_of(solution.costs)},
                       {"scene", scene_text(solution.scene)},
                       {"exact_success", share_of(solution.exact, solution.shots).value}});
    }
    return all;
}

void write_best(const std::string& path, const Solution& best, const std::string& want,
                const SearchArgs& args) {
    write_report(path,
                 fmt::format("# Found by carom for: {}\n# Success with a hand of {}, unknown {}: {}\n{}",
                             harmless(want), args.hand, args.unknown,
                             share_text(share_of(best.successes, best.shots)), scene_text(best.scene)));
}

}  // namespace carom::tools
