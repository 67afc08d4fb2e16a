// carom break: the best break for a hand.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "base/shown_units.h"
#include "base/statistics.h"
#include "carom/engine/math.h"
#include "carom/engine/simulate.h"
#include "carom/games/break.h"
#include "commands/solve/search.h"
#include "page/shot_page.h"
#include "report/diagram.h"
#include "report/table.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;
using games::Solution;

struct BreakArgs {
    games::BreakOptions wanted;
    std::string diagram, page, units = kUnits[0];
    SearchArgs search;
};

std::string told(const Solution& best, const BreakArgs& args, double per_cue, int rank) {
    const Scene& scene = best.scene;
    const carom::Table& table = scene.table;
    const Units units = units_of(args.units);
    const Unit length = length_unit(units);
    const double x = best.values[0], y = best.values[1], hit = best.values[2];
    std::string text = fmt::format("{}. {}", rank, rates_text(best, "break", args.search));
    text += fmt::format(
        "   cue ball {:.2f} diamonds from the left rail and {:.2f} from the head rail ({:.3f}, {:.3f} {})\n",
        4.0 * (x - table.corner.x()) / table.width, 8.0 * (y - table.corner.y()) / table.length,
        x * length.factor, y * length.factor, length.name);
    const double cut = std::asin(std::min(1.0, std::abs(hit))) * kDegrees;
    text += std::abs(hit) < 0.02
                ? fmt::format("   full at the {}\n", games::kBreakApex)
                : fmt::format("   {:.0f} % full at the {}, on its {} side: a cut of {:.0f} degrees\n",
                              100.0 * (1.0 - std::abs(hit)), games::kBreakApex, hit > 0.0 ? "left" : "right",
                              cut);
    const double speed = best.values[3] * per_cue;
    text += fmt::format("   ball at {} ({}), tip {:.2f} ball radii {}\n", speed_text(speed, Units::kMetric),
                        speed_text(speed, Units::kInch), std::abs(best.values[4]),
                        best.values[4] < 0.0 ? "low" : "high");
    return text + falls_text(best) + costs_text(best);
}

games::BreakSearch read_break(const BreakArgs& args) {
    games::BreakOptions options = args.wanted;
    options.seed = args.search.seed;
    try {
        return games::break_search(options);
    } catch (const std::invalid_argument& error) {
        throw UsageError(error.what());
    }
}

int run(const BreakArgs& args) {
    const std::string& game = args.wanted.game;
    const games::BreakSearch asked = read_break(args);
    const Search what{asked.scene, "break of " + game, asked.want, asked.game, asked.choices, asked.racks};
    std::vector<double> starts;
    const std::vector<Solution> found = search(what, args.search, starts);
    const std::string title = fmt::format("{} break, {} rack", game, args.wanted.rack);
    plot_best(what, found[0], title, args.search);
    if (!args.search.output.empty()) write_best(args.search.output, found[0], asked.want, args.search);
    if (!args.diagram.empty() || !args.page.empty()) {
        const Record record = simulate(make_plan(found[0].scene, chosen_isa()));
        if (!args.diagram.empty()) {
            DiagramStyle style;
            style.diamond_numbers = true;
            style.units = units_of(args.units);
            write_report(args.diagram, draw_diagram({{title, record, found[0].scene.cue, {}}}, style,
                                                    diagram_format(args.diagram)));
        }
        if (!args.page.empty())
            write_report(args.page,
                         shot_page(record, nullptr, nullptr, {title, command_line(), program_version()}));
    }
    if (args.search.json) {
        print(Json{{"game", game},
                   {"want", asked.want},
                   {"hand", args.search.hand},
                   {"unknown", args.search.unknown},
                   {"seed", args.search.seed},
                   {"searches", starts},
                   {"solutions", solutions_json(found, asked.choices)}}
                  .dump() +
              "\n");
        return kOk;
    }
    std::string out = fmt::format("{}; wanted: {}; hand: {}\n", title, asked.want, args.search.hand) +
                      lead_text(args.search, starts);
    for (std::size_t i = 0; i < found.size(); ++i)
        out += told(found[i], args, asked.ball_speed, static_cast<int>(i) + 1);
    print(out);
    return kOk;
}

}  // namespace

void add_break(Options& program) {
    auto [command, args] =
        program.command<BreakArgs>("break", "Recommend a break: place, cut, speed, and success rate", run);
    Option& game = command.argument("GAME", args.wanted.game, "The game");
    game.choices.assign(games::kBreakGames.begin(), games::kBreakGames.end());
    command.option("--table", &args.wanted.table, "PRESET", "Preset of the table");
    command.flag("--box", args.wanted.box,
                 "Place the cue ball at least a diamond from either long rail (default: off)");
    command.option("--rack", &args.wanted.rack, "RACK",
                   "template: the balls touch; triangle: 50 micrometres apart; or gap=METRES");
    command.option("--radius-sd", &args.wanted.radius_sd, "METRES",
                   "Standard deviation of the radii of the racked balls");
    command.option("--speed-max", &args.wanted.speed_max, "V", "Maximum cue-ball speed in m/s");
    add_search(command, args.search);
    command.option("--diagram", &args.diagram, "FILE",
                   "Draw the best break: .svg, .pdf or .png (default: not drawn)");
    command.option("--page", &args.page, "FILE.html",
                   "Write a page that plays the best break (default: not written)");
    command.option("--units", &args.units, "UNITS", "Units of lengths").one_of({kUnits[0], kUnits[1]});
}

}  // namespace carom::tools
