// carom-lab accuracy kernel: table, JSON, CSV, plot.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "accuracy/kernel.h"
#include "report/plot.h"
#include "report/table.h"

namespace carom::tools {
namespace {

std::string title_of(const KernelAccuracyRow& row) {
    const bool said = row.method.find("batch") != std::string::npos;
    return row.kind == "batch" && !said ? row.method + ", batch" : row.method;
}

/// Errors below this are rounding noise, and drawn at this value on a logarithmic axis.
constexpr double kFloor = 1e-17;

Table rows_of(const KernelAccuracy& result) {
    Table table(Column("method", "method", "<28"), Column("kind", "kind", "<8"),
                Column("setting", "setting", ">9"), Column("ns", "ns min", ">12.1f"),
                Column("ns_median", "ns median", ">12.1f"), Column("ns_max", "ns max", ">12.1f"),
                Column("error_median", "err median", ">11.1e"), Column("error_p99", "err 99 %", ">11.1e"),
                Column("error_max", "err worst", ">11.1e"), Column("share_of_bound", "", "", false),
                Column("other_model", "", "", false));
    for (const KernelAccuracyRow& r : result.rows)
        table.add({r.method, r.kind, r.setting, r.ns_min, r.ns_median, r.ns_max, r.error_median, r.error_p99,
                   r.error_max, r.share_of_bound ? Cell(*r.share_of_bound) : Cell(), r.other_model},
                  r.other_model ? "  (of the simpler model)" : "");
    return table;
}

/// One row per error.
Table reach_of(const KernelAccuracy& result) {
    Table table(Column("method"), Column("kind"), Column("error"), Column("ns_median"), Column("ns_all"));
    for (const KernelReach& r : result.reach) table.add({r.method, r.kind, r.error, r.ns_median, r.ns_all});
    return table;
}

/// One row per method, one column per error.
Table reach_by_method(const KernelAccuracy& result) {
    Table table(Column("", "", "<28"), Column("", "", "<8"));
    for (const double error : kReachedErrors)
        table.columns.emplace_back("", fmt::format("1e{:.0f}", std::log10(error)), ">22");
    const auto ns = [](double x) { return std::isfinite(x) ? fmt::format("{:.0f}", x) : std::string("-"); };
    for (std::size_t i = 0; i < result.reach.size(); ++i) {
        const KernelReach& r = result.reach[i];
        if (i % std::size(kReachedErrors) == 0) table.add({r.method, r.kind});
        table.rows.back().cells.emplace_back(ns(r.ns_median) + " / " + ns(r.ns_all));
    }
    return table;
}

std::string judged_sentence(const KernelAccuracy& result) {
    std::string text = fmt::format(
        "{} random impacts, {}. Two converged methods (power series in extended precision, "
        "collocation at 1e-13)\nagree on them within {:.1e} of the approach speed",
        result.count, result.isa, result.worst_agreement);
    if (result.disagreeing > 0)
        text += fmt::format("; on {} more they do not, and nothing is said about those", result.disagreeing);
    return text + ".";
}

std::string slope_sentence(const KernelAccuracy& result) {
    return fmt::format("The march's median error falls with N to the power {:.2f}.", result.slope);
}

}  // namespace

std::string kernel_accuracy_text(const KernelAccuracy& result) {
    return judged_sentence(result) + "\n\n" + table_text(rows_of(result)) +
           "\nns to reach an error, for half of the impacts / for all of them\n" +
           table_text(reach_by_method(result)) + "- means that no setting measured here reaches it. " +
           slope_sentence(result) + "\n";
}

std::string kernel_accuracy_json(const KernelAccuracy& result) {
    const nlohmann::ordered_json all = {{"isa", result.isa},
                                        {"impacts", result.count},
                                        {"disagreeing", result.disagreeing},
                                        {"agreement", result.worst_agreement},
                                        {"slope", result.slope},
                                        {"rows", table_json(rows_of(result))},
                                        {"reach", table_json(reach_of(result))}};
    return all.dump(1) + "\n";
}

std::string kernel_accuracy_csv(const KernelAccuracy& result) {
    return table_csv(rows_of(result));
}

Plot kernel_accuracy_plot(const KernelAccuracy& result) {
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
    return plot;
}

Report kernel_accuracy_report(const KernelAccuracy& result) {
    Plot plot = kernel_accuracy_plot(result);
    std::string judged = judged_sentence(result);
    return {plot.title,
            "",
            {std::move(judged), slope_sentence(result)},
            {chart_json(plot, true).dump()},
            {sorted_table_json("Methods and settings", rows_of(result)).dump(),
             sorted_table_json("ns to reach an error, for half of the impacts and for all of them",
                               reach_of(result))
                 .dump()}};
}

}  // namespace carom::tools
