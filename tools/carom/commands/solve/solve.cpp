// carom solve: the shot that most surely does what is wanted.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

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
    int layouts = 64;
    bool exact = false;
    SearchArgs search;
};

// [-] Share of the search's shots that tell how sure an exact shot is; [degrees] how far its aim may turn.
constexpr double kExactShare = 0.1, kTurn = 20.0;

std::optional<double> bound(std::string_view text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

/// "cue.speed=uniform(1,5)"
Choice read_choice(const std::string& text) {
    const std::size_t equals = text.find('='), open = text.find("uniform("), comma = text.rfind(',');
    if (equals != text.npos && open == equals + 1 && comma != text.npos && text.back() == ')') {
        const std::string_view whole = text;
        const auto low = bound(whole.substr(open + 8, comma - open - 8)),
                   high = bound(whole.substr(comma + 1, text.size() - comma - 2));
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

/// The places of all wants such as "cue near (0.6, 1.2, 0.05)". @throws UsageError if there are none
std::vector<games::Place> places_of(const std::vector<std::string>& wants, const Scene& scene) {
    std::vector<games::Place> places;
    for (const std::string& want : wants) {
        const std::size_t near = want.find(" near "), open = want.find('('), close = want.rfind(')');
        if (near == want.npos || open == want.npos || close == want.npos || close < open || open < near)
            continue;
        std::string id = want.substr(0, near);
        std::erase_if(id, [](char c) { return c == '"' || c == ' '; });
        std::string inside = want.substr(open + 1, close - open - 1);
        std::erase(inside, ' ');
        const auto numbers = numbers_in<double, 3>(inside, ',');
        const auto ball = std::find_if(scene.ball.begin(), scene.ball.end(),
                                       [&id](const BallStart& b) { return b.id == id; });
        if (numbers && ball != scene.ball.end())
            places.push_back({static_cast<int>(ball - scene.ball.begin()), {(*numbers)[0], (*numbers)[1]}});
    }
    if (places.empty())
        throw UsageError("--exact: no place is wanted; add one, as in --want 'cue near (0.6, 1.2, 0.05)'");
    return places;
}

/// The shot for which the balls rest at their places, and how sure it is.
struct Exact {
    games::Refined refined;
    std::vector<Choice> choices;
    std::optional<Solution> solution;  ///< nothing if there is no exact shot near
};
Exact exact_of(const Solution& found, const std::vector<Choice>& choices,
               const std::vector<games::Place>& places, const std::string& want,
               const std::optional<games::Game>& game, const SolveArgs& args) {
    Exact exact{{}, choices, {}};
    for (Choice& choice : exact.choices) {
        const double aim = found.scene.cue->aim_deg;
        if (choice.key.starts_with("hit.")) choice = {"cue.aim_deg", aim - kTurn, aim + kTurn};
    }
    const games::Measure wanted(want, found.scene, game);
    exact.refined = games::refine(found.scene, exact.choices, places, chosen_isa(),
                                  [&wanted](const Record& record) { return wanted.holds(record); });
    if (!exact.refined.trouble.empty()) return exact;
    std::vector<Choice> fixed = exact.choices;
    for (std::size_t k = 0; k < fixed.size(); ++k) fixed[k].low = fixed[k].high = exact.refined.values[k];
    SearchArgs once = args.search;
    once.best = 1;
    once.shots = static_cast<std::uint64_t>(kExactShare * static_cast<double>(once.shots));
    once.plot.clear();
    exact.solution = search({exact.refined.scene, args.scene, want, game, fixed, {}}, once)[0];
    return exact;
}

std::string told(const Solution& solution, const std::vector<Choice>& choices, int rank) {
    std::string text =
        fmt::format("{}. {}  of {}\n", rank, share_text(share_of(solution.successes, solution.shots)),
                    counted(solution.shots, "shot"));
    for (std::size_t k = 0; k < choices.size(); ++k)
        text += fmt::format("     {:<24}{:.6g}\n", choices[k].key, solution.values[k]);
    return text + falls_text(solution) + costs_text(solution);
}

int run(const SolveArgs& args) {
    const Plan plan = plan_scene(args.scene);
    std::vector<Choice> choices;
    for (const std::string& text : args.vary) choices.push_back(read_choice(text));
    if (choices.empty()) choices = games::default_choices();
    std::optional<games::Game> game;
    if (!args.game.empty()) game = game_of(args.game);
    const std::string want = joined(args.want);
    const std::vector<Scene> layouts =
        games::racks_of(read_scene_text(args.scene), args.scene, args.layouts, args.search.seed);
    if (args.exact && layouts.size() > 1)
        throw UsageError("--exact: the racks differ, so no shot is exact for all; use --layouts 1");
    if (args.exact) places_of(args.want, plan.scene);
    const Search asked{plan.scene, args.scene, want, game, choices, layouts};
    const std::vector<Solution> found = search(asked, args.search);
    std::vector<Exact> exact;
    if (args.exact) {
        const std::vector<games::Place> places = places_of(args.want, plan.scene);
        for (const Solution& solution : found)
            exact.push_back(exact_of(solution, choices, places, want, game, args));
    }
    const bool is_exact = !exact.empty() && exact[0].solution;
    if (!args.search.output.empty())
        write_best(args.search.output, is_exact ? *exact[0].solution : found[0], want, args.search);
    plot_best(asked, found[0], harmless(args.scene), args.search);
    if (args.search.json) {
        Json all{{"want", want},
                 {"hand", args.search.hand},
                 {"seed", args.search.seed},
                 {"solutions", solutions_json(found, choices)}};
        for (const Exact& e : exact) {
            Json row{{"miss_m", std::isfinite(e.refined.miss) ? Json(e.refined.miss) : Json()},
                     {"shots", e.refined.shots},
                     {"trouble", e.refined.trouble}};
            if (e.solution) row["solution"] = solutions_json({*e.solution}, e.choices)[0];
            all["exact"].push_back(row);
        }
        print(all.dump() + "\n");
        return kOk;
    }
    std::string text = fmt::format("wanted: {}\n", harmless(want));
    for (std::size_t i = 0; i < found.size(); ++i) {
        text += told(found[i], choices, static_cast<int>(i) + 1);
        if (exact.empty()) continue;
        const games::Refined& refined = exact[i].refined;
        if (exact[i].solution)
            text += fmt::format("   exactly there, within {:.1g} mm after {}:\n", 1e3 * refined.miss,
                                counted(static_cast<std::size_t>(refined.shots), "shot")) +
                    told(*exact[i].solution, exact[i].choices, static_cast<int>(i) + 1);
        else
            text += fmt::format("   no exact shot near it: {}\n", refined.trouble);
    }
    print(text);
    return kOk;
}

}  // namespace

void add_solve(Options& program) {
    auto [command, args] = program.command<SolveArgs>(
        "solve", "Find the shot that most surely does what is wanted, with a hand that errs", run);
    command.argument("SCENE", args.scene, "Scene file (TOML)").required = true;
    command
        .option("--want", &args.want, "EXPRESSION",
                "What the shot has to do (carom describe measures); several must all hold")
        .required = true;
    command.option(
        "--vary", &args.vary, "KEY=uniform(a,b)",
        "What the search may choose; hit.BALL=uniform(-1,1) aims at a ball (default: aim, speed and "
        "height of the tip)");
    command.flag("--exact", args.exact,
                 "Move the shots until the balls rest at the centre of every near (default: off)");
    command.option("--game", &args.game, "GAME", "What measures such as foul judge by (default: none)")
        .one_of(game_names());
    command
        .option("--layouts", &args.layouts, "N", "Racks that the shot must cope with, if the scene has one")
        .in(1, 100000);
    add_search(command, args.search);
}

}  // namespace carom::tools
