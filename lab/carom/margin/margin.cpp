// carom-lab margin: the command.
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "carom/engine/printable.h"
#include "margin/lab_margin.h"
#include "report/html.h"
#include "report/margin_chart.h"
#include "report/plot.h"
#include "report/table.h"

namespace carom::tools {
namespace {

Report margin_report(const Margin& margin, const MarginRun& last, const std::string& scene) {
    Report report{"Margin of " + scene, margin_lead(margin), {}, {}, {}};
    std::istringstream sentences(margin_sentences(margin, last));
    for (std::string sentence; std::getline(sentences, sentence);) report.notes.push_back(sentence);
    report.charts = {margin_chart(margin, last, scene).dump()};
    report.tables = {sorted_table_json("Stages, ms per frame", stages_table(margin)).dump(),
                     sorted_table_json("Frames", frames_table(margin, last)).dump()};
    return report;
}

int run(const LabMarginArgs& asked) {
    LabMarginArgs args = asked;
    read_margin_args(args);
    check_page_path("--html", args.html);
    if (args.sweep && !args.trace.empty())
        throw UsageError("--trace is of one setting: it cannot be combined with --sweep");
    if (args.sweep && args.fps)
        throw UsageError("--sweep goes through the frame rates: it cannot be combined with --fps");
    const Plan plan = plan_scene(args.scene);
    if (args.sweep) return run_margin_sweep(plan, args);
    const auto [margin, last] = measure_margin(plan, args);
    write_report(args.csv, table_csv(frames_table(margin, last)));
    if (!args.plot.empty()) write_plot(margin_plot(margin, last, harmless(args.scene)), args.plot);
    if (!args.html.empty()) write_html_report(margin_report(margin, last, harmless(args.scene)), args.html);
    write_report(args.trace, margin_trace(last, margin.fps));
    print(args.json ? margin_json(margin, last) : margin_text(margin, last, harmless(args.scene)));
    return kOk;
}

}  // namespace

void add_lab_margin(Options& program) {
    auto [command, args] =
        program.command<LabMarginArgs>("margin", "The margin of a scene as a plot, a page or a trace", run);
    add_margin_options(command, args);
    command.flag("--sweep", args.sweep,
                 "Every accuracy at every frame rate from 30 to 1000: where the scene stops being real time "
                 "(default: off)");
    command.option("--trace", &args.trace, "FILE.json",
                   "Write the frames as Chrome trace events (default: not written)");
    add_html(command, args.html);
}

}  // namespace carom::tools
