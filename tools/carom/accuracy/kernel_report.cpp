// carom accuracy kernel: table, JSON, CSV, plot.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "accuracy/kernel.h"
#include "report/plot.h"

namespace carom::tools {
namespace {

std::string title_of(const KernelAccuracyRow& row) {
    const bool said = row.method.find("batch") != std::string::npos;
    return row.kind == "batch" && !said ? row.method + ", batch" : row.method;
}

/// What rounding leaves of one error: below it a logarithmic axis would only show noise.
constexpr double kFloor = 1e-17;

}  // namespace

std::string kernel_accuracy_text(const KernelAccuracy& result) {
    fmt::memory_buffer out;
    const auto line = std::back_inserter(out);
    fmt::format_to(line,
                   "{} random impacts, {}. Two converged methods (power series in extended precision, "
                   "collocation at 1e-13)\nagree on them within {:.1e} of the approach speed",
                   result.count, result.isa, result.worst_agreement);
    if (result.disagreeing > 0)
        fmt::format_to(line, "; on {} more they do not, and nothing is said about those", result.disagreeing);
    fmt::format_to(line, ".\n\n{:<28}{:<8}{:>9}{:>12}{:>12}{:>12}{:>11}{:>11}{:>11}\n", "method", "kind",
                   "setting", "ns min", "ns median", "ns max", "err median", "err 99 %", "err worst");
    for (const KernelAccuracyRow& r : result.rows)
        fmt::format_to(line, "{:<28}{:<8}{:>9}{:>12.1f}{:>12.1f}{:>12.1f}{:>11.1e}{:>11.1e}{:>11.1e}{}\n",
                       r.method, r.kind, r.setting, r.ns_min, r.ns_median, r.ns_max, r.error_median,
                       r.error_p99, r.error_max, r.other_model ? "  (of the simpler model)" : "");
    fmt::format_to(line, "\nns to reach an error, for half of the impacts / for all of them\n{:<36}", "");
    for (const char* error : {"1e-3", "1e-6", "1e-9", "1e-12"}) fmt::format_to(line, "{:>22}", error);
    const auto ns = [](double x) { return std::isfinite(x) ? fmt::format("{:.0f}", x) : std::string("-"); };
    for (std::size_t i = 0; i < result.reach.size(); ++i) {
        const KernelReach& r = result.reach[i];
        if (i % 4 == 0) fmt::format_to(line, "\n{:<28}{:<8}", r.method, r.kind);
        fmt::format_to(line, "{:>22}", ns(r.ns_median) + " / " + ns(r.ns_all));
    }
    fmt::format_to(line,
                   "\n- means that no setting measured here reaches it. The march's median error falls with "
                   "N to the power {:.2f}.\n",
                   result.slope);
    return fmt::to_string(out);
}

std::string kernel_accuracy_json(const KernelAccuracy& result) {
    using Json = nlohmann::ordered_json;
    Json rows = Json::array(), reach = Json::array();
    for (const KernelAccuracyRow& r : result.rows)
        rows.push_back({{"method", r.method},
                        {"kind", r.kind},
                        {"setting", r.setting},
                        {"ns", r.ns_min},
                        {"ns_median", r.ns_median},
                        {"ns_max", r.ns_max},
                        {"error_median", r.error_median},
                        {"error_p99", r.error_p99},
                        {"error_max", r.error_max},
                        {"other_model", r.other_model}});
    const auto number = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
    for (const KernelReach& r : result.reach)
        reach.push_back({{"method", r.method},
                         {"kind", r.kind},
                         {"error", r.error},
                         {"ns_median", number(r.ns_median)},
                         {"ns_all", number(r.ns_all)}});
    const Json all = {{"isa", result.isa},
                      {"impacts", result.count},
                      {"disagreeing", result.disagreeing},
                      {"agreement", result.worst_agreement},
                      {"slope", number(result.slope)},
                      {"rows", rows},
                      {"reach", reach}};
    return all.dump(1) + "\n";
}

std::string kernel_accuracy_csv(const KernelAccuracy& result) {
    std::string text = "method,kind,setting,ns,ns_median,ns_max,error_median,error_p99,error_max\n";
    for (const KernelAccuracyRow& r : result.rows)
        text += fmt::format("{},{},{},{},{},{},{},{},{}\n", r.method, r.kind, r.setting, r.ns_min,
                            r.ns_median, r.ns_max, r.error_median, r.error_p99, r.error_max);
    return text;
}

void plot_kernel_accuracy(const KernelAccuracy& result, const std::string& path) {
    Plot plot;
    plot.title = "What the accuracy of one impact costs";
    plot.notes = {fmt::format("{} random impacts, {}; full lines: median error; dashed: worst", result.count,
                              result.isa)};
    plot.x = {"ns per impact", true, {}, {}};
    plot.y = {"error / approach speed", true, {}, {}};
    int colour = 0;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const std::string title = title_of(result.rows[i]);
        const bool known = std::any_of(plot.series.begin(), plot.series.end(),
                                       [&title](const Series& s) { return s.name == title; });
        if (known) continue;
        Series median{title, {}, true, true, false, colour}, worst{"", {}, true, false, true, colour};
        for (const KernelAccuracyRow& r : result.rows) {
            if (title_of(r) != title) continue;
            median.points.emplace_back(r.ns_min, std::max(r.error_median, kFloor));
            worst.points.emplace_back(r.ns_min, std::max(r.error_max, kFloor));
        }
        plot.series.push_back(median);
        plot.series.push_back(worst);
        ++colour;
    }
    write_plot(plot, path);
}

}  // namespace carom::tools
