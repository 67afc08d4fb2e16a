// carom diagram: shots drawn for a handout.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "carom/engine/printable.h"
#include "report/diagram.h"
#include "report/table.h"

namespace carom::tools {
namespace {

struct DiagramArgs {
    std::vector<std::string> shots;
    std::vector<std::string> titles;
    std::string output = "shot.svg";
    std::string units = kUnits[0];
    bool black_and_white = false;
    bool diamonds = false;
};

/// The first comment of a scene, else the name of the file.
std::string default_title(const std::string& path) {
    std::string title = is_record(path) ? "" : harmless(scene_title(read_scene_text(path)));
    if (title.empty()) title = std::filesystem::path(harmless(path)).stem().string();
    std::replace(title.begin(), title.end(), '_', ' ');
    return title;
}

int run(const DiagramArgs& args) {
    const std::string format = diagram_format(args.output);
    if (args.titles.size() > args.shots.size())
        throw UsageError(fmt::format("--title: {} for {}; give at most one for each",
                                     counted(args.titles.size(), "title"),
                                     counted(args.shots.size(), "shot")));
    std::vector<DiagramShot> shots;
    for (const std::string& path : args.shots) {
        DiagramShot shot;
        shot.title =
            shots.size() < args.titles.size() ? harmless(args.titles[shots.size()]) : default_title(path);
        if (is_record(path)) {
            shot.record = read_shot(path, {});
        } else {
            const Plan plan = plan_scene(path);
            shot.cue = plan.scene.cue;
            shot.record = simulate_plan(plan, {});
        }
        shots.push_back(std::move(shot));
    }
    DiagramStyle style;
    style.color = !args.black_and_white;
    style.diamond_numbers = args.diamonds;
    style.units = units_of(args.units);
    write_report(args.output, draw_diagram(shots, style, format));
    print(fmt::format("{}: {}\n", harmless(args.output), counted(shots.size(), "shot")));
    return kOk;
}

}  // namespace

void add_diagram(Options& program) {
    auto [command, args] = program.command<DiagramArgs>(
        "diagram", "Draw shots for a handout: the table to scale, balls, paths, the tip of the cue", run);
    command.option("SHOT", &args.shots, "", "Scene files (TOML) or records (.json), one drawing each")
        .required = true;
    command.option("-o,--output", &args.output, "FILE", "Drawing to write: .svg, .pdf or .png");
    command.option("--title", &args.titles, "TEXT",
                   "Title of a shot; repeat it for each shot (default: from the scene's first comment)");
    command.flag("--bw", args.black_and_white,
                 "Draw in black and white, for printers without colour (default: off)");
    command.flag("--diamonds", args.diamonds, "Number the diamonds (default: off)");
    command.option("--units", &args.units, "UNITS", "Units of speeds, positions and the radius")
        .one_of({kUnits[0], kUnits[1]});
}

}  // namespace carom::tools
