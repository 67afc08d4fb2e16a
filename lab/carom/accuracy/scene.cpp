// carom-lab accuracy: the report of `carom accuracy` as a plot or a page, compared with Box2D, and the same
// for one impact.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "accuracy/box2d_shot.h"
#include "accuracy/kernel.h"
#include "base/clock.h"
#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "carom/engine/printable.h"
#include "carom/engine/simulate.h"
#include "commands/accuracy/scene.h"
#include "report/html.h"
#include "report/plot.h"
#include "report/table.h"

namespace carom::tools {
namespace {

struct LabAccuracyArgs : AccuracySceneArgs {
    bool box2d = false;
    /// A file name; empty: not written.
    std::string html;
};

void measure_box2d(SceneAccuracy& result, const Scene& scene) {
    const Record truth = simulate_plan(with_tolerance(scene, kernel::kTightestTolerance), {});
    const ShotContacts outcome = contacts_of(scene, truth);
    const std::vector<Vec2> end = final_positions(truth);
    constexpr double kRates[] = {60.0, 120.0, 240.0, 1000.0, 10000.0};
    ProgressLine progress("accuracy, Box2D:");
    for (const double hz : kRates) {
        SceneAccuracyRow row;
        row.method = "box2d";
        row.other_simulator = true;
        row.setting = fmt::format("{:g} Hz", hz);
        row.value = hz;
        Box2dOutcome shot;
        std::vector<double> samples;
        for (int i = 0; i < 3; ++i) {
            throw_if_interrupted();
            const double start = thread_ns();
            shot = run_box2d(truth, hz);
            samples.push_back(thread_ns() - start);
        }
        set_times(row, samples);
        row.error = final_error(shot.positions, end);
        row.first_same = shot.first_contact == outcome.first_contact;
        row.pocketed_same = shot.pockets == outcome.pockets;
        result.rows.push_back(row);
        progress.show_bar(static_cast<long>(result.rows.size()), static_cast<long>(result.rows.size()) + 1);
    }
}

Report report_of(const SceneAccuracy& result, const std::string& scene) {
    std::vector<std::string> notes = scene_accuracy_notes(result, scene);
    notes.push_back(result.sentence);
    return {"Accuracy of " + scene,
            "",
            std::move(notes),
            {chart_json(scene_accuracy_plot(result, scene), true).dump()},
            {sorted_table_json("Settings", scene_accuracy_table(result)).dump()}};
}

int run(const LabAccuracyArgs& args) {
    check_page_path("--html", args.html);
    const Plan plan = plan_for_accuracy(args);
    SceneAccuracy result = measure_scene_accuracy(plan.scene, args);
    if (args.box2d) measure_box2d(result, plan.scene);
    write_report(args.csv, table_csv(scene_accuracy_table(result)));
    if (!args.plot.empty()) write_plot(scene_accuracy_plot(result, harmless(args.scene)), args.plot);
    if (!args.html.empty()) write_html_report(report_of(result, harmless(args.scene)), args.html);
    print(args.json ? scene_accuracy_json(result) : scene_accuracy_text(result, harmless(args.scene)));
    return kOk;
}

}  // namespace

void add_lab_accuracy(Options& program) {
    auto [command, args] = program.command<LabAccuracyArgs>(
        "accuracy", "What accuracy costs in time: of a shot (SCENE), or of one impact (kernel)", run);
    add_accuracy_options(command, args);
    command.flag("--box2d", args.box2d,
                 "Also the same shot in a Box2D world stepped at 60 Hz to 10 kHz (default: off)");
    add_html(command, args.html);
    add_accuracy_kernel(command);
}

}  // namespace carom::tools
