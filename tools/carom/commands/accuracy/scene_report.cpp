// carom accuracy SCENE: table, JSON, sentences.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/console.h"
#include "commands/accuracy/scene.h"
#include "report/table.h"

namespace carom::tools {
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
