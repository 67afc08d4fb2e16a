// carom margin: the command.
#include "commands/margin/margin.h"

#include <fmt/format.h>

#include <utility>

#include "base/console.h"
#include "base/setup.h"
#include "carom/engine/printable.h"
#include "report/margin_chart.h"
#include "report/plot.h"
#include "report/table.h"

namespace carom::tools {

MeasuredMargin measure_margin(const Plan& plan, const MarginArgs& args) {
    const double fps = chosen_fps(args.fps, plan.scene.render);
    const double start_ms = process_ms();
    std::vector<MarginRun> runs;
    for (int run = 0; run < args.repeat; ++run) {
        runs.push_back(
            one_run(plan, args.drawing(), fps, fmt::format("run {} of {}:", run + 1, args.repeat)));
        // Only the last record is read.
        if (run > 0) runs[static_cast<std::size_t>(run) - 1].record = {};
    }
    Margin margin = combine(runs, fps, !args.no_render);
    if (margin.rendered) margin.size = args.drawn.size.value_or(plan.scene.render.size());
    const double before_ms = process_ms();
    margin.timing = cost_of_timing(plan);
    margin.accounting.start_ms = start_ms;
    margin.accounting.timing_ms = process_ms() - before_ms;
    margin.accounting.wall_ms = process_ms();
    return {std::move(margin), std::move(runs.back())};
}

namespace {

int run(const MarginArgs& asked) {
    MarginArgs args = asked;
    read_margin_args(args);
    const auto [margin, last] = measure_margin(plan_scene(args.scene), args);
    write_report(args.csv, table_csv(frames_table(margin, last)));
    if (!args.plot.empty()) write_plot(margin_plot(margin, last, harmless(args.scene)), args.plot);
    print(args.json ? margin_json(margin, last) : margin_text(margin, last, harmless(args.scene)));
    return kOk;
}

}  // namespace

void read_margin_args(MarginArgs& args) {
    check_plot_path(args.plot);
    if (!args.size.empty()) args.drawn.size = parse_size(args.size);
}

void add_margin_options(Options& command, MarginArgs& args) {
    command.argument("SCENE", args.scene, "Scene file (TOML)").required = true;
    add_picture(command, args.fps, args.size);
    add_repeat(command, args.repeat, "Number of runs; a frame's cost is its median over them");
    command.flag("--no-render", args.no_render, "Measure only the simulation (default: off)");
    add_gl(command, args.drawn.gl);
    add_plot(command, args.plot);
    add_reports(command, args.csv, args.json);
    command.footer =
        "simulate = detect + resolve + kernel + cluster. A frame costs simulate + draw + readback + encode + "
        "write.";
}

void add_margin(Options& program) {
    auto [command, args] = program.command<MarginArgs>(
        "margin", "Measure the real-time margin: the cost of every frame against 1/fps", run);
    add_margin_options(command, args);
}

}  // namespace carom::tools
