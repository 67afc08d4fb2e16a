// carom break: the break that a player with this hand should play.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/console.h"
#include "base/options.h"
#include "base/output_file.h"
#include "base/setup.h"
#include "base/statistics.h"
#include "base/units.h"
#include "carom/engine/printable.h"
#include "carom/engine/simulate.h"
#include "commands/solve/search.h"
#include "page/shot_page.h"
#include "report/diagram.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;
using games::Choice;
using games::Solution;

/// A game with a break: the ball that stands in front, and what a good break does.
struct BreakGame {
    const char* name;
    const char* apex;
    const char* rack;  ///< more keys of [rack]
    const char* want;
    std::optional<games::Game> game;
};
const BreakGame kGames[] = {
    {"nine_ball", "1", "spot_ball = 9\n", "any_pocketed and legal_break", games::Game::kNineBall},
    {"ten_ball", "1", "", "any_pocketed and not scratch", std::nullopt},
    {"eight_ball", "1", "", "any_pocketed and legal_break", games::Game::kEightBall},
};

struct BreakArgs {
    std::string game = "nine_ball", table = "nine_foot", rack = "template", diagram, page, units = kUnits[0];
    double speed_max = 10.0;
    bool box = false;
    SearchArgs search;
};

/// [m] How far neighbours in the rack are apart.
double gap_of(const std::string& rack) {
    // A template presses the balls together; a triangle leaves them about this far apart.
    if (rack == "template") return 0.0;
    if (rack == "triangle") return 5e-5;
    if (rack.starts_with("gap=")) {
        const auto read = numbers_in<double, 1>(rack.substr(4), ',');
        if (read && (*read)[0] >= 0.0 && (*read)[0] <= 0.001) return (*read)[0];
    }
    throw UsageError(
        fmt::format("--rack {}: expected template, triangle or gap=METRES with 0 to 0.001", harmless(rack)));
}

std::string scene_of(const BreakGame& game, const BreakArgs& args) {
    const double gap = gap_of(args.rack);
    return fmt::format(
        "[table]\npreset = \"{}\"\n[rack]\ngame = \"{}\"\n{}gap = {}\njitter = {}\n"
        "[[ball]]\nid = \"cue\"\nposition = [0.3, 0.3]\n[cue]\npreset = \"break\"\nspeed = 5\noffset = [0, "
        "0]\n",
        args.table, game.name, game.rack, gap, 0.5 * gap);
}

/// [m/s] What the ball gets from one metre per second of the cue, hit in its centre.
double gain(const Scene& scene) {
    Scene alone = scene;
    for (BallStart& ball : alone.ball)
        if (ball.id == alone.cue->ball) alone.ball = {BallStart(ball)};
    alone.cue->speed = 1.0;
    alone.cue->side = alone.cue->height = 0.0;
    alone.stop.events = 1;
    const Record record = simulate(make_plan(alone, chosen_isa()));
    return record.state_at(0, 0.0).velocity.norm();
}

std::string told(const Solution& best, const BreakArgs& args, double per_cue, int rank) {
    const Scene& scene = best.scene;
    const carom::Table& table = scene.table;
    const Units units = units_of(args.units);
    const Unit length = length_unit(units);
    const double x = best.values[0], y = best.values[1], hit = best.values[2];
    std::string text = fmt::format("{}. {}  of {}\n", rank, share_text(share_of(best.successes, best.shots)),
                                   counted(best.shots, "break"));
    text += fmt::format(
        "   cue ball {:.2f} diamonds from the left rail and {:.2f} from the head rail ({:.3f}, {:.3f} {})\n",
        4.0 * (x - table.corner.x()) / table.width, 8.0 * (y - table.corner.y()) / table.length,
        x * length.factor, y * length.factor, length.name);
    const double cut = std::asin(std::min(1.0, std::abs(hit))) * 180.0 / std::numbers::pi;
    text +=
        std::abs(hit) < 0.02
            ? fmt::format("   full at the {}\n", kGames[0].apex)
            : fmt::format("   {:.0f} % full at the {}, on its {} side: a cut of {:.0f} degrees\n",
                          100.0 * (1.0 - std::abs(hit)), kGames[0].apex, hit > 0.0 ? "left" : "right", cut);
    const double speed = best.values[3] * per_cue;
    text += fmt::format("   ball at {} ({}), tip {:.2f} ball radii {}\n", speed_text(speed, Units::kMetric),
                        speed_text(speed, Units::kInch), std::abs(best.values[4]),
                        best.values[4] < 0.0 ? "low" : "high");
    return text + falls_text(best) + costs_text(best);
}

int run(const BreakArgs& args) {
    if (!(args.speed_max >= 1.0 && args.speed_max <= 20.0))
        throw UsageError("--speed-max: expected 1 to 20 m/s");
    const BreakGame* game = nullptr;
    for (const BreakGame& known : kGames)
        if (args.game == known.name) game = &known;
    const std::string text = scene_of(*game, args), name = "break of " + args.game;
    const Scene scene = parse_scene(text, name);
    const double R = scene.balls.R, line = 0.25 * scene.table.length, per_cue = gain(scene);
    const double side = args.box ? 0.25 * scene.table.width : R;
    const Vec2 corner = scene.table.corner;
    const std::vector<Choice> choices = {
        {"ball.cue.position.x", corner.x() + side + 1e-4, corner.x() + scene.table.width - side - 1e-4},
        {"ball.cue.position.y", corner.y() + 0.1 * scene.table.length, corner.y() + line - 1e-4},
        {std::string("hit.") + game->apex, -0.9, 0.9},
        {"cue.speed", 0.3 * args.speed_max / per_cue, args.speed_max / per_cue},
        {"cue.offset.height", -0.35, 0.35}};
    const std::vector<Scene> layouts = read_layouts(64, [&](const std::vector<std::string>& rules) {
        return Variation::from_text(text, name, rules, args.search.seed);
    });
    const std::vector<Solution> found =
        search(scene, name, game->want, game->game, choices, layouts, args.search);
    const std::string title = fmt::format("{} break, {} rack", args.game, args.rack);
    if (!args.search.output.empty()) write_best(args.search.output, found[0], game->want, args.search);
    if (!args.diagram.empty() || !args.page.empty()) {
        const Record record = simulate(make_plan(found[0].scene, chosen_isa()));
        if (!args.diagram.empty()) {
            DiagramStyle style;
            style.diamond_numbers = true;
            style.units = units_of(args.units);
            OutputFile file(args.diagram);
            file.write(
                draw_diagram({{title, record, found[0].scene.cue}}, style, diagram_format(args.diagram)));
            file.commit();
        }
        if (!args.page.empty()) {
            OutputFile file(args.page);
            file.write(shot_page(record, nullptr, nullptr, {title, command_line(), program_version()}));
            file.commit();
        }
    }
    if (args.search.json) {
        print(Json{{"game", args.game},
                   {"want", game->want},
                   {"hand", args.search.hand},
                   {"seed", args.search.seed},
                   {"solutions", solutions_json(found, choices)}}
                  .dump() +
              "\n");
        return kOk;
    }
    std::string out = fmt::format("{}; wanted: {}; hand: {}\n", title, game->want, args.search.hand);
    for (std::size_t i = 0; i < found.size(); ++i)
        out += told(found[i], args, per_cue, static_cast<int>(i) + 1);
    print(out);
    return kOk;
}

}  // namespace

void add_break(Options& program) {
    auto [command, args] = program.command<BreakArgs>(
        "break", "Recommend a break: where from, how full, how hard, and how sure it is", run);
    Option& game = command.argument("GAME", args.game, "The game (default: nine_ball)");
    for (const BreakGame& known : kGames) game.choices.emplace_back(known.name);
    command.option("--table", &args.table, "PRESET", "The table, as a scene names it");
    command.flag("--box", args.box, "The cue ball at least a diamond from either long rail (default: off)");
    command.option("--rack", &args.rack, "RACK",
                   "template: the balls touch; triangle: 50 micrometres apart; or gap=METRES");
    command.option("--speed-max", &args.speed_max, "V",
                   "The hardest that the player hits: speed of the cue ball in m/s");
    add_search(command, args.search);
    command.option("--diagram", &args.diagram, "FILE",
                   "Draw the best break: .svg, .pdf or .png (default: not drawn)");
    command.option("--page", &args.page, "FILE.html", "Write a page that plays it (default: not written)");
    command.option("--units", &args.units, "UNITS", "Units of lengths").one_of({kUnits[0], kUnits[1]});
}

}  // namespace carom::tools
