// carom accuracy SCENE: the measurement.
#include "commands/accuracy/scene.h"
#include "carom/engine/printable.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "carom/engine/ball_ball.h"
#include "carom/engine/simulate.h"
#include "report/table.h"

namespace carom::tools {
namespace {

/// The converged runs must agree within this fraction of the target; otherwise, differences from them are not
/// errors.
constexpr double kAgreement = 0.1;

/// One setting: how to run it, and its result.
struct SceneSubject {
    SceneAccuracyRow row;
    Plan plan;
};

std::vector<SceneSubject> subjects(const Scene& scene, const AccuracySceneArgs& args,
                                   std::optional<double> recommended) {
    std::vector<SceneSubject> list;
    const auto add = [&list](const char* method, std::string setting, double value, Plan plan) {
        SceneSubject& s = list.emplace_back(SceneSubject{{}, std::move(plan)});
        s.row.method = method;
        s.row.setting = std::move(setting);
        s.row.value = value;
    };
    for (const int n : args.march) {
        add("march", fmt::format("N={}", n), n, with_substeps(scene, n));
        add("march published", fmt::format("N={}", n), n, with_substeps(scene, n, March::kPublished));
    }
    std::vector<double> tolerances = args.tolerances;
    if (recommended && std::find(tolerances.begin(), tolerances.end(), *recommended) == tolerances.end())
        tolerances.insert(std::find_if(tolerances.begin(), tolerances.end(),
                                       [&](double tolerance) { return tolerance < *recommended; }),
                          *recommended);
    for (const double tolerance : tolerances)
        add("tolerance", fmt::format("{:g}", tolerance), tolerance, with_tolerance(scene, tolerance));
    return list;
}

/// Takes the shares of kernel and cluster map from the least disturbed profiled run.
void set_shares(SceneAccuracyRow& row, const Plan& plan) {
    constexpr int kRuns = 3;
    SimulateOptions options = interruptible();
    options.profile = true;
    double least = INFINITY;
    for (int run = 0; run < kRuns; ++run) {
        const Record record = simulate(plan, options);
        double all = record.setup_detect_ns, kernel = 0.0, cluster = 0.0;
        for (std::size_t i = 0; i < record.costs.size(); ++i) {
            const EventCost& cost = record.costs[i];
            all += cost.detect_ns + cost.resolve_ns;
            (record.events[i].type == EventType::kBallCluster ? cluster : kernel) += cost.kernel_ns;
        }
        if (all >= least) continue;
        least = all;
        row.kernel_share = kernel / all;
        row.cluster_share = cluster / all;
    }
}

void compare(SceneAccuracyRow& row, const Scene& scene, const Record& record, const ShotContacts& truth,
             const std::vector<Vec2>& end) {
    const ShotContacts outcome = contacts_of(scene, record);
    row.order_same = outcome.contacts == truth.contacts;
    row.first_same = outcome.first_contact == truth.first_contact;
    row.pocketed_same = outcome.pockets == truth.pockets;
    row.error = final_error(final_positions(record), end);
}

const SceneAccuracyRow* row_of(const SceneAccuracy& result, const char* method, double value) {
    for (const SceneAccuracyRow& row : result.rows)
        if (row.method == method && row.value == value) return &row;
    return nullptr;
}

/// The march to compare with: N = 1000, as in the paper, else the first one.
const SceneAccuracyRow* compared_march(const SceneAccuracy& result) {
    if (const SceneAccuracyRow* row = row_of(result, "march", 1000.0)) return row;
    for (const SceneAccuracyRow& row : result.rows)
        if (row.method == "march") return &row;
    return nullptr;
}

/// The loosest tolerance such that it and every tighter one met the target.
std::optional<double> loosest_measured(const SceneAccuracy& result) {
    std::vector<const SceneAccuracyRow*> rows;
    for (const SceneAccuracyRow& row : result.rows)
        if (row.method == "tolerance") rows.push_back(&row);
    std::sort(rows.begin(), rows.end(), [](auto* a, auto* b) { return a->value < b->value; });
    std::optional<double> loosest;
    for (const SceneAccuracyRow* row : rows) {
        if (!row->failed.empty() || row->error.largest > result.target) break;
        loosest = row->value;
    }
    return loosest;
}

std::string metres(double x) {
    return x >= 1e-3 ? fmt::format("{:.3g} m", x) : fmt::format("{:.1e} m", x);
}

std::string sentence_of(const SceneAccuracy& result) {
    if (!result.converged)
        return fmt::format(
            "The two converged methods end {} apart (gain {:.1e}), so differences here are not errors, and "
            "no setting guarantees {}.",
            metres(result.agreement), result.gain, metres(result.target));
    if (!result.recommended)
        return fmt::format(
            "Double precision does not allow {}: the gain of this shot is {:.1e}, so it would need a "
            "tolerance below {:g}; the two converged runs end {} apart.",
            metres(result.target), result.gain, kernel::kTightestTolerance, metres(result.agreement));
    const SceneAccuracyRow* row = row_of(result, "tolerance", *result.recommended);
    std::string text;
    if (row->failed.empty() && row->error.largest <= result.target) {
        text = fmt::format("Tolerance {:g} is enough for {} (error {}", *result.recommended,
                           metres(result.target), metres(row->error.largest));
        text += result.loosest && *result.loosest > *result.recommended
                    ? fmt::format("; {:g} is also enough here)", *result.loosest)
                    : ")";
    } else {
        text = fmt::format("The gain requires tolerance {:g}, but its error is {}, more than {}",
                           *result.recommended, metres(row->error.largest), metres(result.target));
    }
    if (const SceneAccuracyRow* march = compared_march(result)) {
        if (march->failed.empty())
            text += fmt::format("; {} would have an error of {} and take {:.3g} times as long",
                                march->setting, metres(march->error.largest), march->ns_min / row->ns_min);
    }
    return text + ".";
}

}  // namespace

void set_times(SceneAccuracyRow& row, const std::vector<double>& samples) {
    row.ns_min = minimum(samples);
    row.ns_median = median(samples);
    row.ns_max = *std::max_element(samples.begin(), samples.end());
}

SceneAccuracy measure_scene_accuracy(const Scene& scene, const AccuracySceneArgs& args) {
    SceneAccuracy result;
    result.target = args.target;
    const Plan tight = with_tolerance(scene, kernel::kTightestTolerance);
    const Record truth = simulate_plan(tight, {});
    const Record other = simulate_plan(with_reference(scene), {});
    const ShotContacts outcome = contacts_of(scene, truth), other_outcome = contacts_of(scene, other);
    const std::vector<Vec2> end = final_positions(truth);
    result.contacts = outcome.contacts.size();
    for (const Event& event : truth.events) result.ball_hits += balls_collide(event.type) ? 1U : 0U;
    result.agreement = final_error(final_positions(other), end).largest;
    result.outcome_agrees =
        outcome.contacts == other_outcome.contacts && outcome.pockets == other_outcome.pockets;
    result.converged = result.outcome_agrees && result.agreement <= kAgreement * args.target;
    result.clusters = has_clusters(truth);
    result.twin = twin_step(truth);
    result.gain = gain_of(tight, truth);
    if (result.converged) result.recommended = deserved_tolerance(result.gain, args.target);

    std::vector<SceneSubject> list = subjects(scene, args, result.recommended);
    for (SceneSubject& s : list) {
        throw_if_interrupted();
        try {
            compare(s.row, scene, simulate(s.plan, interruptible()), outcome, end);
            if (result.clusters) {
                Plan only = tight;
                only.cluster_tolerance = s.plan.cluster_tolerance;
                s.row.cluster_error =
                    final_error(final_positions(simulate(only, interruptible())), end).largest;
            }
            set_shares(s.row, s.plan);
        } catch (const SimulationError& error) {
            s.row.failed = error.what();
            s.row.failed.resize(std::min(s.row.failed.size(), s.row.failed.find('\n')));
        }
    }
    const auto samples = interleaved("accuracy, times:", list.size(), args.repeat, [&list](std::size_t i) {
        if (!list[i].row.failed.empty()) return 0.0;
        const double start = thread_ns();
        const Record record = simulate(list[i].plan, interruptible());
        return thread_ns() - start;
    });
    for (std::size_t i = 0; i < list.size(); ++i) {
        set_times(list[i].row, samples[i]);
        result.rows.push_back(list[i].row);
    }
    if (result.converged) {
        result.loosest = loosest_measured(result);
        // A recommendation that this shot does not meet is none.
        if (result.recommended && !(result.loosest && *result.loosest >= *result.recommended))
            result.recommended = result.loosest;
    }
    result.sentence = sentence_of(result);
    return result;
}

void add_accuracy_options(Options& command, AccuracySceneArgs& args) {
    command.argument("SCENE", args.scene, "Scene file (TOML)");
    command.option("--target", &args.target, "M", "Final error to aim for, in m");
    command.option("--march", &args.march, "N,...", "Settings N of the march to compare").in(1, 100000000);
    command.option("--tolerance", &args.tolerances, "E,...", "Tolerances to compare")
        .in(kernel::kTightestTolerance, kernel::kLoosestTolerance);
    add_repeat(command, args.repeat,
               "Number of interleaved rounds; times are their minimum, median and maximum");
    add_plot(command, args.plot);
    add_reports(command, args.csv, args.json);
}

Plan plan_for_accuracy(const AccuracySceneArgs& args) {
    check_plot_path(args.plot);
    if (args.scene.empty()) throw UsageError("accuracy: no scene file given; see --help");
    if (!(args.target > 0.0 && std::isfinite(args.target)))
        throw UsageError(fmt::format("--target {}: expected a number of metres greater than 0", args.target));
    Plan plan = plan_scene(args.scene);
    if (!plan.scene.physics.ball_ball->reads_tolerance)
        throw UsageError(
            fmt::format("{}: ball_ball = \"{}\" is a closed formula without an accuracy setting; set "
                        "ball_ball = \"mathavan\"",
                        args.scene, name(plan.scene.physics.ball_ball)));
    return plan;
}

namespace {

int run(const AccuracySceneArgs& args) {
    const SceneAccuracy result = measure_scene_accuracy(plan_for_accuracy(args).scene, args);
    write_report(args.csv, table_csv(scene_accuracy_table(result)));
    if (!args.plot.empty()) write_plot(scene_accuracy_plot(result, harmless(args.scene)), args.plot);
    print(args.json ? scene_accuracy_json(result) : scene_accuracy_text(result, harmless(args.scene)));
    return kOk;
}

}  // namespace

void add_accuracy(Options& program) {
    auto [command, args] = program.command<AccuracySceneArgs>(
        "accuracy", "Measure accuracy against time, and find the tolerance that a shot needs", run);
    add_accuracy_options(command, args);
}

namespace {

/// An error below the difference of the two converged runs is not resolved.
std::string error_text(double error, const SceneAccuracy& result) {
    return error < result.agreement ? fmt::format("<{:.1e}", result.agreement) : fmt::format("{:.1e}", error);
}

std::string gain_sentence(const SceneAccuracy& result) {
    return fmt::format("{}. Gain {:.2e}: a ball displaced by {:g} m ends up to {:.1e} m off.",
                       counted(result.contacts, "contact"), result.gain, result.twin,
                       result.gain * result.twin);
}

std::string converged_sentence(const SceneAccuracy& result) {
    return fmt::format(
        "Two converged methods ({}) end {:.1e} m apart; their outcomes are {}.",
        result.clusters
            ? "collocation at 1e-13 and clusters at 1e-11; power series in extended precision and "
              "clusters in short steps between located events"
            : "collocation at 1e-13; power series in extended precision",
        result.agreement, result.outcome_agrees ? "the same" : "different");
}

/// The settings that every run holds fixed.
std::string fixed_sentence(const SceneAccuracy& result) {
    if (!result.clusters)
        return "Held fixed: the models, and the gap of 1e-8 m that resting contacts may keep.";
    return "Held fixed: the models, and in clusters the regularisation of friction, which errs by 1.4e-3 of "
           "the fastest approach against Coulomb's law: it can move the ends of a break by decimetres.";
}

}  // namespace

Table scene_accuracy_table(const SceneAccuracy& result) {
    Table table(Column("method", "method", "<16"), Column("setting", "setting", ">10"),
                Column("ns", "ms min", ">12"), Column("ns_median", "ms median", ">12"), Column("ns_max"),
                Column("kernel_share", "kernel", ">9"), Column("cluster_share", "cluster", ">9"),
                Column("", "error m", ">11"), Column("cluster_error", "cluster m", ">11"),
                Column("error_median", "median m", ">11"), Column("error_max"),
                Column("same_order", "order", ">9"), Column("same_first_contact", "first", ">9"),
                Column("same_pocketed", "pockets", ">9"));
    const auto in_ms = [](double ns) { return Cell(ns, fmt::format("{:.4f}", ns * 1e-6)); };
    const auto error = [&result](double x) {
        return result.converged ? Cell(x, error_text(x, result)) : Cell();
    };
    const auto share = [](double x) { return Cell(x, fmt::format("{:.0f} %", 100.0 * x)); };
    const auto same = [](bool x) { return Cell(x, x ? "same" : "differs"); };
    for (const SceneAccuracyRow& r : result.rows) {
        const bool ours = !r.other_simulator;
        if (r.failed.empty())
            table.add({r.method, r.setting, in_ms(r.ns_min), in_ms(r.ns_median), r.ns_max,
                       ours ? share(r.kernel_share) : Cell(), ours ? share(r.cluster_share) : Cell(),
                       error(r.error.largest), result.clusters && ours ? error(r.cluster_error) : Cell(),
                       error(r.error.median), error(r.error.largest), ours ? same(r.order_same) : Cell(),
                       same(r.first_same), same(r.pocketed_same)});
        else
            table.add({r.method, r.setting}, "  failed: " + r.failed);
    }
    return table;
}

Plot scene_accuracy_plot(const SceneAccuracy& result, const std::string& scene) {
    constexpr double kLeastError = 1e-16;  // [m] a logarithmic axis has no 0
    Plot plot;
    plot.title = "Cost of accuracy: " + scene;
    plot.notes = {result.converged ? fmt::format("gain {:.1e}; converged runs agree within {:.1e} m",
                                                 result.gain, result.agreement)
                                   : "the converged runs do not agree: distances, not errors"};
    plot.x = {"ms for the shot", true, {}, {}};
    plot.y = {"largest final distance from the converged run, m", true, {}, {}};
    for (const char* method : {"march", "march published", "tolerance", "box2d"}) {
        Series series;
        series.name = method == std::string("box2d") ? "Box2D, 60 Hz to 10 kHz" : method;
        for (const SceneAccuracyRow& r : result.rows)
            if (r.method == method && r.failed.empty())
                series.points.emplace_back(r.ns_min * 1e-6, std::max(r.error.largest, kLeastError));
        if (!series.points.empty()) plot.series.push_back(series);
    }
    const auto recommended =
        std::find_if(result.rows.begin(), result.rows.end(), [&](const SceneAccuracyRow& r) {
            return r.method == "tolerance" && result.recommended == r.value && r.failed.empty();
        });
    if (recommended != result.rows.end())
        plot.series.push_back(
            {fmt::format("recommended: {:g}", recommended->value),
             {{recommended->ns_min * 1e-6, std::max(recommended->error.largest, kLeastError)}},
             false});
    plot.levels = {{fmt::format("target {:g} m", result.target), result.target}};
    return plot;
}

std::vector<std::string> scene_accuracy_notes(const SceneAccuracy& result, const std::string& scene) {
    return {scene + ": " + gain_sentence(result), converged_sentence(result), fixed_sentence(result)};
}

std::string scene_accuracy_text(const SceneAccuracy& result, const std::string& scene) {
    return fmt::format("{}\n\n", fmt::join(scene_accuracy_notes(result, scene), "\n")) +
           table_text(scene_accuracy_table(result)) + "\n" + result.sentence + "\n";
}

std::string scene_accuracy_json(const SceneAccuracy& result) {
    using Json = nlohmann::ordered_json;
    Json rows = table_json(scene_accuracy_table(result));
    for (std::size_t i = 0; i < result.rows.size(); ++i)
        if (!result.rows[i].failed.empty()) rows[i]["failed"] = result.rows[i].failed;
    const Json all = {
        {"target", result.target},
        {"gain", result.gain},
        {"contacts", result.contacts},
        {"ball_hits", result.ball_hits},
        {"agreement", result.agreement},
        {"same_outcome", result.outcome_agrees},
        {"converged", result.converged},
        {"recommended_tolerance", result.recommended ? Json(*result.recommended) : Json(nullptr)},
        {"loosest_tolerance_measured", result.loosest ? Json(*result.loosest) : Json(nullptr)},
        {"recommendation", result.sentence},
        {"rows", rows}};
    return all.dump(1) + "\n";
}

}  // namespace carom::tools
