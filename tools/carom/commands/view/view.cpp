// carom view: a shot as one HTML page that plays it.
#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/console.h"
#include "base/margin.h"
#include "base/options.h"
#include "base/setup.h"
#include "carom/engine/printable.h"
#include "page/shot_page.h"
#include "report/margin_chart.h"
#include "report/table.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;

struct ViewArgs {
    std::string input, second;  ///< a scene, or a record (.json); `second` may be empty
    std::string output = "shot.html";
    std::string gl = "auto";
    bool margin = false;  ///< draw and time the frames
};

/// A shot, and the cost of its frames if known.
struct MeasuredShot {
    Record record;
    Json margin = nullptr;  ///< a chart
};

/// Simulates and draws a scene once, and times both.
MeasuredShot measured_scene(const ViewArgs& args) {
    const Plan plan = plan_scene(args.input);
    const RenderSettings& settings = plan.scene.render;
    const FrameSettings drawn{{}, args.gl};
    std::vector<MarginRun> runs;
    runs.push_back(one_run(plan, &drawn, settings.fps, "the margin of every frame:"));
    Margin margin = combine(runs, settings.fps, true);
    margin.size = settings.size();
    Json chart = margin_chart(margin, runs.front(), harmless(args.input));
    return {std::move(runs.front().record), std::move(chart)};
}

/// A record is not simulated again. If profiled, it contains the simulation cost of each frame.
MeasuredShot read_record_shot(const ViewArgs& args) {
    std::vector<MarginRun> runs(1);
    Record& record = runs.front().record;
    record = read_shot(args.input, {});
    if (record.costs.empty()) {
        if (!args.margin) return {std::move(record)};
        throw UsageError(fmt::format(
            "--margin: {} is not profiled; use the scene, or a record from carom simulate --profile",
            harmless(args.input)));
    }
    const double fps = record.render.fps;
    runs.front().frames = costs_by_frame(record, 0.0, fps, checked_frame_count(0.0, record.duration, fps));
    for (const FrameCost& frame : runs.front().frames) add_simulation(runs.front(), frame);
    Json chart = margin_chart(combine(runs, fps, false), runs.front(), harmless(args.input));
    return {std::move(record), std::move(chart)};
}

MeasuredShot first_shot(const ViewArgs& args) {
    if (is_record(args.input)) return read_record_shot(args);
    if (args.margin) return measured_scene(args);
    SimulateOptions options;
    options.profile = true;
    return {read_shot(args.input, options)};
}

int run(const ViewArgs& args) {
    check_page_path("-o", args.output);
    const MeasuredShot shot = first_shot(args);
    std::optional<Record> second;
    if (!args.second.empty()) second = read_shot(args.second, {});
    const std::string title = harmless(second ? args.input + " and " + args.second : args.input);
    const std::string html = shot_page(shot.record, second ? &*second : nullptr, shot.margin,
                                       {title, harmless(command_line()), program_version()});
    write_report(args.output, html);
    print(fmt::format("{}: {}, {} kB\n", args.output, shot_lead(shot.record), (html.size() + 500) / 1000));
    return kOk;
}

}  // namespace

void add_view(Options& program) {
    auto [command, args] = program.command<ViewArgs>("view", "Write one HTML page that plays a shot", run);
    command.argument("SCENE", args.input, "Scene file (TOML) or record (.json)").required = true;
    command.argument("SECOND", args.second, "Second shot, shown over or beside the first (default: none)");
    command.option("-o,--output", &args.output, "FILE.html", "Page to write; FILE.html#t=1.5 opens at 1.5 s");
    command.flag("--margin", args.margin,
                 "Draw and time every frame, and chart the cost of each (default: off)");
    add_gl(command, args.gl);
}

}  // namespace carom::tools
