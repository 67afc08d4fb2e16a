// carom fit: numbers of a scene from tracked positions of its balls.
#include "carom/games/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "carom/engine/printable.h"
#include "carom/interface/shape.h"
#include "commands/fit/tracks.h"
#include "report/table.h"

namespace carom::tools {
namespace {

struct FitArgs {
    std::string scene, tracks, output, csv;
    std::vector<std::string> vary;
    int shots = 100;
    bool json = false;
};

/// "balls.mu_s,balls.mu_r", and the option may be repeated.
std::vector<std::string> keys_of(const std::vector<std::string>& options) {
    std::vector<std::string> keys;
    for (const std::string& option : options)
        for (std::size_t begin = 0; begin <= option.size();) {
            const std::size_t end = std::min(option.find(',', begin), option.size());
            keys.push_back(option.substr(begin, end - begin));
            begin = end + 1;
        }
    return keys;
}

Table values_table(const games::Fit& fit, const std::vector<std::string>& keys) {
    Table table(Column("key", "", "<28"), Column("value", "value", ">14.6g"),
                Column("deviation", "+-", ">12.2g"), Column("start", "start", ">14.6g"));
    const std::vector<double> deviations = fit.deviations();
    for (std::size_t k = 0; k < keys.size(); ++k) {
        const double deviation = deviations[k];
        table.add(
            {keys[k], fit.values[k], std::isfinite(deviation) ? Cell(deviation) : Cell(), fit.start[k]});
    }
    return table;
}

std::string residuals_csv(const games::Fit& fit, const std::vector<games::TrackPoint>& points) {
    Table table(Column("t"), Column("ball"), Column("x"), Column("y"), Column("dx"), Column("dy"));
    for (std::size_t i = 0; i < points.size(); ++i)
        table.add({points[i].time, fit.scene.ball[static_cast<std::size_t>(points[i].ball)].id,
                   points[i].place.x(), points[i].place.y(), fit.residuals[i].x(), fit.residuals[i].y()});
    return table_csv(table);
}

int run(const FitArgs& args) {
    const std::vector<std::string> keys = keys_of(args.vary);
    const Plan plan = plan_scene(args.scene);
    const std::vector<games::TrackPoint> points = read_tracks(args.tracks, plan.scene);
    games::Fit fit;
    try {
        fit = games::fit(plan.scene, points, {keys, args.shots}, plan.isa);
    } catch (const std::invalid_argument& error) {
        throw UsageError(fmt::format("--vary {}", error.what()));
    }
    for (const std::string& warning : fit.warnings) message(warning);
    if (!fit.converged) message("the fit failed: " + fit.message);
    write_report(args.output,
                 fmt::format("# Fitted by carom to {}\n{}", harmless(args.tracks), scene_text(fit.scene)));
    write_report(args.csv, residuals_csv(fit, points));
    const Table table = values_table(fit, keys);
    if (args.json)
        print(interface::value_of(fit).dump() + "\n");
    else
        print(table_text(table) +
              fmt::format("\n{} of {}: typically {:.3g} mm off, {} beyond three times that; {}\n",
                          counted(fit.points, "position"), points.size(), 1e3 * fit.noise,
                          counted(fit.outliers, "coordinate"),
                          counted(static_cast<std::size_t>(fit.shots), "shot")));
    return fit.converged ? kOk : kFailed;
}

}  // namespace

void add_fit(Options& program) {
    auto [command, args] = program.command<FitArgs>(
        "fit", "Fit frictions, restitutions or the stroke to tracked positions of the balls", run);
    command.argument("SCENE", args.scene, "Scene file (TOML): the shot, with first guesses").required = true;
    command.argument("TRACKS", args.tracks, "Positions of the balls (CSV): t,ball,x,y in s and m").required =
        true;
    command
        .option("--vary", &args.vary, "KEY,...",
                "Keys to fit, as in balls.mu_s,balls.mu_r,cue.speed; clock is the time of the stroke in the "
                "tracks")
        .required = true;
    command.option("--most-shots", &args.shots, "N", "Give up after this many shots").in(1, 1e6);
    command.option("-o,--output", &args.output, "FILE.toml",
                   "Write the scene with the fitted values (default: not written)");
    command.option("--csv", &args.csv, "FILE.csv",
                   "Write simulated minus tracked positions, for a plot (default: not written)");
    command.flag("--json", args.json, "Print JSON, with the covariance (default: off)");
}

}  // namespace carom::tools
