// carom-lab margin --sweep: the accuracy and frame rate at which a scene stops being real time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/console.h"
#include "base/setup.h"
#include "carom/engine/ball_ball.h"
#include "carom/engine/printable.h"
#include "carom/engine/simulate.h"
#include "commands/accuracy/scene.h"
#include "margin/lab_margin.h"
#include "report/html.h"
#include "report/plot.h"
#include "report/table.h"

namespace carom::tools {
namespace {

constexpr double kRates[] = {30.0, 60.0, 120.0, 240.0, 480.0, 1000.0};
/// Frames are drawn once, at this rate. At other rates, a frame is assigned the cost of the drawn frame
/// nearest in time, which shows nearly the same picture.
constexpr double kDrawnRate = 60.0;

struct Setting {
    std::string method, text;
    Plan plan;
};

/// The cost of a setting at one frame rate.
struct RateCost {
    double fps = 0.0;
    long frames = 0, missed = 0;
    double worst_ms = 0.0, p99_ms = 0.0, worst_simulate_ms = 0.0;
};

struct SettingRow {
    std::string method, text;
    std::vector<RateCost> costs;
    std::optional<double> frontier;  ///< highest rate up to which no frame was missed
};

std::vector<Setting> settings_of(const Plan& plan) {
    std::vector<Setting> list;
    if (!plan.scene.physics.ball_ball->reads_tolerance) {
        list.push_back({name(plan.scene.physics.ball_ball), "", plan});
        return list;
    }
    for (const int n : {100, 1000, 10000, 100000})
        list.push_back({"march", fmt::format("N={}", n), with_substeps(plan.scene, n)});
    for (const double t : {1e-3, 1e-6, 1e-9, 1e-12})
        list.push_back({"tolerance", fmt::format("{:g}", t), with_tolerance(plan.scene, t)});
    return list;
}

/// Simulation cost of every frame, median over the runs [ms].
std::vector<double> simulate_costs(const std::vector<Record>& runs, double fps) {
    const long frames = checked_frame_count(0.0, runs.front().duration, fps);
    std::vector<std::vector<double>> samples(static_cast<std::size_t>(std::max(frames, 1L)));
    for (const Record& record : runs) {
        const std::vector<FrameCost> costs = costs_by_frame(record, 0.0, fps, frames);
        for (std::size_t k = 0; k < costs.size(); ++k) samples[k].push_back(costs[k].simulate_ms());
    }
    std::vector<double> costs(samples.size());
    std::transform(samples.begin(), samples.end(), costs.begin(), [](const auto& s) { return median(s); });
    return costs;
}

/// Costs of drawing to writing at kDrawnRate, medians over the runs; empty without rendering.
std::vector<double> drawn_costs(const Plan& plan, const LabMarginArgs& args) {
    if (args.no_render) return {};
    std::vector<MarginRun> runs;
    runs.reserve(static_cast<std::size_t>(args.repeat));
    for (int run = 0; run < args.repeat; ++run)
        runs.push_back(one_run(plan, args.drawing(), kDrawnRate,
                               fmt::format("drawing {} of {}:", run + 1, args.repeat)));
    const Margin margin = combine(runs, kDrawnRate, true);
    std::vector<double> costs;
    for (std::size_t k = 0; k < margin.total.size(); ++k)
        costs.push_back(margin.total[k] - margin.stage[kSimulate][k]);
    return costs;
}

RateCost cost_at(const std::vector<Record>& runs, const std::vector<double>& drawn, double fps) {
    RateCost cost;
    cost.fps = fps;
    std::vector<double> total = simulate_costs(runs, fps);
    cost.frames = static_cast<long>(total.size());
    cost.worst_simulate_ms = *std::max_element(total.begin(), total.end());
    for (std::size_t k = 0; k < total.size() && !drawn.empty(); ++k) {
        const double time = render::frame_time(0.0, static_cast<long>(k), fps);
        const auto nearest = static_cast<std::size_t>(std::lround(time * kDrawnRate));
        total[k] += drawn[std::min(nearest, drawn.size() - 1)];
    }
    cost.missed = std::count_if(total.begin(), total.end(), [fps](double ms) { return ms > 1000.0 / fps; });
    const Spread s = spread(total);
    cost.p99_ms = s.p99;
    cost.worst_ms = s.max;
    return cost;
}

std::vector<SettingRow> sweep(const Plan& plan, const LabMarginArgs& args) {
    const std::vector<double> drawn = drawn_costs(plan, args);
    std::vector<SettingRow> rows;
    const std::vector<Setting> settings = settings_of(plan);
    ProgressLine progress("margin --sweep:");
    for (const Setting& setting : settings) {
        std::vector<Record> runs;
        for (int run = 0; run < args.repeat; ++run) {
            SimulateOptions options = interruptible();
            options.profile = true;
            runs.push_back(simulate(setting.plan, options));
        }
        SettingRow row{setting.method, setting.text, {}, {}};
        bool so_far = true;
        for (const double fps : kRates) {
            row.costs.push_back(cost_at(runs, drawn, fps));
            so_far = so_far && row.costs.back().missed == 0;
            if (so_far) row.frontier = fps;
        }
        rows.push_back(row);
        progress.show_bar(static_cast<long>(rows.size()), static_cast<long>(settings.size()));
    }
    return rows;
}

/// One row per setting and frame rate.
Table table_of(const std::vector<SettingRow>& rows) {
    Table table(Column("method"), Column("setting"), Column("fps"), Column("budget_ms", "", "", false),
                Column("frames"), Column("missed"), Column("p99_ms"), Column("worst_ms"),
                Column("worst_simulate_ms"));
    for (const SettingRow& row : rows)
        for (const RateCost& c : row.costs)
            table.add({row.method, row.text, c.fps, 1000.0 / c.fps, c.frames, c.missed, c.p99_ms, c.worst_ms,
                       c.worst_simulate_ms});
    return table;
}

/// One row per setting: the fastest rate up to which it missed no frame.
Table frontier_of(const std::vector<SettingRow>& rows) {
    Table table(Column("method"), Column("setting"), Column("fps"));
    for (const SettingRow& row : rows)
        table.add({row.method, row.text, row.frontier ? Cell(*row.frontier) : Cell()});
    return table;
}

/// One row per setting, one column per frame rate.
Table missed_by_setting(const std::vector<SettingRow>& rows) {
    Table table(Column("", "", "<22"));
    for (const double fps : kRates) table.columns.emplace_back("", fmt::format("{} fps", fps), ">15");
    for (const SettingRow& row : rows) {
        table.add({row.method + " " + row.text});
        for (const RateCost& c : row.costs)
            table.rows.back().cells.emplace_back(
                fmt::format("{} ({:.0f} %)", c.missed, c.worst_ms * c.fps / 10.0));
    }
    return table;
}

std::string sweep_json(const std::vector<SettingRow>& rows) {
    const nlohmann::ordered_json all = {{"rows", table_json(table_of(rows))},
                                        {"frontier", table_json(frontier_of(rows))}};
    return all.dump() + "\n";
}

std::string sweep_text(const std::vector<SettingRow>& rows, const LabMarginArgs& args) {
    std::string text = fmt::format(
        "{}: frames missed (worst frame, % of its time); {}\n\n{}\n", harmless(args.scene),
        args.no_render ? "simulation only" : "simulated, drawn, encoded and written on one thread",
        table_text(missed_by_setting(rows)));
    for (const SettingRow& row : rows)
        text += fmt::format("{} {}: {}\n", row.method, row.text,
                            row.frontier ? fmt::format("real time up to {} fps", *row.frontier)
                                         : fmt::format("not real time at {} fps", kRates[0]));
    return text;
}

Plot sweep_plot(const std::vector<SettingRow>& rows, const LabMarginArgs& args) {
    Plot plot;
    plot.title = "Where the scene stops being real time: " + harmless(args.scene);
    plot.notes = {args.no_render ? "worst frame of the shot, simulation only"
                                 : "worst frame of the shot, drawn, encoded and written on one thread"};
    plot.x = {"frames per second", true, {}, {}};
    plot.y = {"ms of the worst frame", true, {}, {}};
    Series budget{"1/fps", {}, true, false, true, 6};
    for (const double fps : kRates) budget.points.emplace_back(fps, 1000.0 / fps);
    plot.series.push_back(budget);
    int number = 0;
    for (const SettingRow& row : rows) {
        Series series{row.method + " " + row.text, {}, true, true, row.method == "march", number++ % 6};
        for (const RateCost& c : row.costs) series.points.emplace_back(c.fps, c.worst_ms);
        plot.series.push_back(series);
    }
    return plot;
}

}  // namespace

int run_margin_sweep(const Plan& plan, const LabMarginArgs& args) {
    const std::vector<SettingRow> rows = sweep(plan, args);
    write_report(args.csv, table_csv(table_of(rows)));
    const Plot plot = sweep_plot(rows, args);
    if (!args.plot.empty()) write_plot(plot, args.plot);
    write_html_report(
        {plot.title,
         "",
         plot.notes,
         {chart_json(plot, true).dump()},
         {sorted_table_json("The fastest rate without a missed frame", frontier_of(rows)).dump(),
          sorted_table_json("Settings and rates", table_of(rows)).dump()}},
        args.html);
    print(args.json ? sweep_json(rows) : sweep_text(rows, args));
    return kOk;
}

}  // namespace carom::tools
