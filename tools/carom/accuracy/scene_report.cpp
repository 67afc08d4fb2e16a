// carom accuracy SCENE: table, JSON, CSV, plot.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "accuracy/scene.h"
#include "console.h"
#include "report/plot.h"

namespace carom::tools {
namespace {

const char* yes(bool same) {
    return same ? "same" : "differs";
}

/// An error below what the two converged runs differ by is not resolved.
std::string error_text(double error, const SceneAccuracy& result) {
    if (!result.converged) return "-";
    return error < result.agreement ? fmt::format("<{:.1e}", result.agreement) : fmt::format("{:.1e}", error);
}

}  // namespace

std::string scene_accuracy_text(const SceneAccuracy& result, const std::string& scene) {
    fmt::memory_buffer out;
    const auto line = std::back_inserter(out);
    fmt::format_to(line,
                   "{}: {}. Gain {:.2e}: a ball put 1e-12 m beside its place ends up to {:.1e} m "
                   "off.\nTwo converged methods (collocation at 1e-13, power series in extended precision) "
                   "end {:.1e} m apart, outcome {}.\n\n",
                   scene, counted(result.contacts, "contact"), result.gain, result.gain * kTwinStep,
                   result.agreement, result.outcome_agrees ? "the same" : "not the same");
    fmt::format_to(line, "{:<11}{:>10}{:>12}{:>12}{:>9}{:>9}{:>11}{:>11}{:>9}{:>9}{:>9}\n", "method",
                   "setting", "ms min", "ms median", "kernel", "cluster", "error m", "median m", "order",
                   "first", "pockets");
    for (const SceneAccuracyRow& r : result.rows) {
        fmt::format_to(line, "{:<11}{:>10}", r.method, r.setting);
        if (!r.failed.empty()) {
            fmt::format_to(line, "  failed: {}\n", r.failed);
            continue;
        }
        fmt::format_to(line, "{:>12.4f}{:>12.4f}", r.ns_min * 1e-6, r.ns_median * 1e-6);
        const bool ours = r.method != "box2d";
        fmt::format_to(line, "{:>9}{:>9}", ours ? fmt::format("{:.0f} %", 100.0 * r.kernel_share) : "-",
                       ours ? fmt::format("{:.0f} %", 100.0 * r.cluster_share) : "-");
        fmt::format_to(line, "{:>11}{:>11}{:>9}{:>9}{:>9}\n", error_text(r.error.largest, result),
                       error_text(r.error.median, result), ours ? yes(r.order_same) : "-", yes(r.first_same),
                       yes(r.pocketed_same));
    }
    fmt::format_to(line, "\n{}\n", result.sentence);
    return fmt::to_string(out);
}

std::string scene_accuracy_json(const SceneAccuracy& result) {
    using Json = nlohmann::ordered_json;
    Json rows = Json::array();
    for (const SceneAccuracyRow& r : result.rows) {
        if (!r.failed.empty()) {
            rows.push_back({{"method", r.method}, {"setting", r.setting}, {"failed", r.failed}});
            continue;
        }
        const bool ours = r.method != "box2d";
        const auto called = [&result](double error) {
            return result.converged ? Json(error) : Json(nullptr);
        };
        rows.push_back({{"method", r.method},
                        {"setting", r.setting},
                        {"ns", r.ns_min},
                        {"ns_median", r.ns_median},
                        {"ns_max", r.ns_max},
                        {"kernel_share", ours ? Json(r.kernel_share) : Json(nullptr)},
                        {"cluster_share", ours ? Json(r.cluster_share) : Json(nullptr)},
                        {"error_median", called(r.error.median)},
                        {"error_max", called(r.error.largest)},
                        {"same_order", ours ? Json(r.order_same) : Json(nullptr)},
                        {"same_first_contact", r.first_same},
                        {"same_pocketed", r.pocketed_same}});
    }
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

std::string scene_accuracy_csv(const SceneAccuracy& result) {
    std::string text =
        "method,setting,ns,ns_median,ns_max,kernel_share,cluster_share,error_median,error_max,same_order,"
        "same_first_contact,same_pocketed\n";
    for (const SceneAccuracyRow& r : result.rows) {
        if (!r.failed.empty()) continue;
        const bool ours = r.method != "box2d";
        const auto called = [&result](double error) {
            return result.converged ? fmt::format("{}", error) : std::string();
        };
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", r.method, r.setting, r.ns_min,
                            r.ns_median, r.ns_max, ours ? fmt::format("{}", r.kernel_share) : "",
                            ours ? fmt::format("{}", r.cluster_share) : "", called(r.error.median),
                            called(r.error.largest), ours ? fmt::format("{:d}", r.order_same) : "",
                            static_cast<int>(r.first_same), static_cast<int>(r.pocketed_same));
    }
    return text;
}

void plot_scene_accuracy(const SceneAccuracy& result, const std::string& scene, const std::string& path) {
    Plot plot;
    plot.title = "What accuracy costs: " + scene;
    plot.notes = {result.converged ? fmt::format("gain {:.1e}; converged runs agree within {:.1e} m",
                                                 result.gain, result.agreement)
                                   : "the converged runs do not agree: distances, not errors"};
    plot.x = {"ms for the shot", true, {}, {}};
    plot.y = {"largest final distance from the converged run, m", true, {}, {}};
    for (const char* method : {"march", "tolerance", "box2d"}) {
        Series series;
        series.name = method == std::string("box2d") ? "Box2D, 60 Hz to 10 kHz" : method;
        for (const SceneAccuracyRow& r : result.rows)
            if (r.method == method && r.failed.empty())
                series.points.emplace_back(r.ns_min * 1e-6, std::max(r.error.largest, 1e-16));
        if (!series.points.empty()) plot.series.push_back(series);
    }
    plot.levels = {{fmt::format("target {:g} m", result.target), result.target}};
    write_plot(plot, path);
}

}  // namespace carom::tools
