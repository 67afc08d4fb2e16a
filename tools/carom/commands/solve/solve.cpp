// carom solve: the shot most likely to achieve a goal.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/as_number.h"
#include "base/console.h"
#include "base/game_state.h"
#include "base/options.h"
#include "base/setup.h"
#include "base/statistics.h"
#include "carom/engine/printable.h"
#include "carom/games/break.h"
#include "carom/games/refine.h"
#include "commands/solve/search.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;
using games::Choice;
using games::Solution;

struct SolveArgs {
    std::string scene, game;
    std::vector<std::string> want, vary;
    int layouts = 0;
    bool exact = false;
    SearchArgs search;
};

/// "cue.speed=uniform(1,5)"
Choice read_choice(const std::string& text) {
    const std::size_t equals = text.find('='), open = text.find("uniform("), comma = text.rfind(',');
    if (equals != text.npos && open == equals + 1 && comma != text.npos && text.back() == ')') {
        const std::string_view whole = text;
        const auto low = as_number<double>(whole.substr(open + 8, comma - open - 8)),
                   high = as_number<double>(whole.substr(comma + 1, text.size() - comma - 2));
        if (low && high && *low <= *high) return {text.substr(0, equals), *low, *high};
    }
    throw UsageError(fmt::format(
        "--vary {}: expected KEY=uniform(a,b) with a <= b, as in cue.speed=uniform(1,5)", harmless(text)));
}

std::string joined(const std::vector<std::string>& parts) {
    std::string whole;
    for (const std::string& part : parts) whole += (whole.empty() ? "(" : " and (") + part + ")";
    return parts.size() == 1 ? parts.front() : whole;
}

/// @param rank  "1. ", or "   " below the solution of that rank
std::string told(const Solution& solution, const std::vector<Choice>& choices, const std::string& rank,
                 const SearchArgs& args) {
    std::string text = rank + rates_text(solution, "shot", args);
    for (std::size_t k = 0; k < choices.size(); ++k)
        text += fmt::format("     {:<24}{:.6g}\n", choices[k].key, solution.values[k]);
    return text + falls_text(solution) + costs_text(solution);
}

/// An earlier exact shot with the same values, if any: two shots of different kind may lead to it.
std::optional<std::size_t> same_before(const std::vector<games::Exact>& exact, std::size_t i) {
    // [of a value] The shots are exact to less.
    constexpr double kSame = 1e-4;
    if (!exact[i].solution) return std::nullopt;
    const std::vector<double>& values = exact[i].solution->values;
    for (std::size_t k = 0; k < i; ++k) {
        if (!exact[k].solution) continue;
        const std::vector<double>& other = exact[k].solution->values;
        if (std::equal(values.begin(), values.end(), other.begin(), other.end(), [](double a, double b) {
                return std::abs(a - b) <= kSame * std::max({1.0, std::abs(a), std::abs(b)});
            }))
            return k;
    }
    return std::nullopt;
}

int run(const SolveArgs& args) {
    const Plan plan = plan_scene(args.scene);
    std::vector<Choice> choices;
    for (const std::string& text : args.vary) choices.push_back(read_choice(text));
    if (choices.empty()) choices = games::default_choices();
    std::optional<games::Game> game;
    if (!args.game.empty()) game = game_of(args.game);
    const std::string want = joined(args.want);
    const games::Racks racks =
        games::racks_of(read_scene_text(args.scene), args.scene, args.layouts, args.search.seed);
    if (args.exact && racks)
        throw UsageError("--exact: the racks differ, so no shot is exact for all; use --layouts 1");
    std::vector<games::Exact> exact;
    std::vector<double> starts;
    const Search asked{plan.scene, args.scene, want, game, choices, racks};
    const std::vector<Solution> found = search(asked, args.search, starts, args.exact ? &exact : nullptr);
    const bool is_exact = !exact.empty() && exact[0].solution;
    if (!args.search.output.empty())
        write_best(args.search.output, is_exact ? *exact[0].solution : found[0], want, args.search);
    plot_best(asked, found[0], harmless(args.scene), args.search);
    if (args.search.json) {
        Json all{{"want", want},
                 {"hand", args.search.hand},
                 {"unknown", args.search.unknown},
                 {"seed", args.search.seed},
                 {"searches", starts},
                 {"solutions", solutions_json(found, choices)}};
        for (const games::Exact& e : exact) {
            Json row{{"miss", std::isfinite(e.refined.miss) ? Json(e.refined.miss) : Json()},
                     {"shots", e.refined.shots},
                     {"trouble", e.refined.trouble}};
            if (e.solution) row["solution"] = solutions_json({*e.solution}, e.choices)[0];
            all["exact"].push_back(row);
        }
        print(all.dump() + "\n");
        return kOk;
    }
    std::string text = fmt::format("wanted: {}\n", harmless(want)) + lead_text(args.search, starts);
    for (std::size_t i = 0; i < found.size(); ++i) {
        text += told(found[i], choices, fmt::format("{}. ", i + 1), args.search);
        if (exact.empty()) continue;
        const games::Refined& refined = exact[i].refined;
        if (const auto first = same_before(exact, i))
            text += fmt::format("   exactly there: as in {}.\n", *first + 1);
        else if (exact[i].solution)
            text += fmt::format("   exactly there, within {:.1g} mm after {}:\n", 1e3 * refined.miss,
                                counted(static_cast<std::size_t>(refined.shots), "shot")) +
                    told(*exact[i].solution, exact[i].choices, "   ", args.search);
        else
            text += fmt::format("   no exact shot near it: {}\n", refined.trouble);
    }
    print(text);
    return kOk;
}

}  // namespace

void add_solve(Options& program) {
    auto [command, args] = program.command<SolveArgs>(
        "solve", "Find the shot most likely to achieve a goal, given the player's errors", run);
    command.argument("SCENE", args.scene, "Scene file (TOML)").required = true;
    command
        .option("--want", &args.want, "EXPRESSION",
                "The goal, an expression (see carom describe measures); if repeated, all must hold")
        .required = true;
    command.option("--vary", &args.vary, "KEY=uniform(a,b)",
                   "Search this input; hit.BALL=uniform(-1,1) aims at a ball (default: aim, speed and height "
                   "of the tip)");
    command.flag("--exact", args.exact,
                 "Refine the shots until the balls rest at the centre of every near (default: off)");
    command.option("--game", &args.game, "GAME", "Rules for measures such as foul (default: none)")
        .one_of(game_names());
    command
        .option("--layouts", &args.layouts, "N",
                "Number of random racks to play the shot on, if the scene has a rack; 0: a new one for each "
                "shot")
        .in(0, 100000);
    add_search(command, args.search);
}

}  // namespace carom::tools
