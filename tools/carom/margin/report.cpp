// carom margin: table, JSON, CSV, plot, trace.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "bench/clock.h"
#include "console.h"
#include "margin/margin.h"
#include "report/html.h"
#include "report/plot.h"
#include "report/table.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;

Json spread_json(const std::vector<double>& values) {
    const Spread v = spread(values);
    return {{"p50", v.p50}, {"p95", v.p95}, {"p99", v.p99}, {"max", v.max}};
}

Json event_json(const Record& record, std::size_t i) {
    const Event& event = record.events[i];
    const EventCost& cost = record.costs.at(i);
    return {{"time", event.time},
            {"type", name(event.type)},
            {"a", record.tracks.at(event.a).id},
            {"b", record.partner_id(event)},
            {"detect_ns", cost.detect_ns},
            {"resolve_ns", cost.resolve_ns},
            {"kernel_ns", cost.kernel_ns}};
}

double time_of(const Margin& margin, std::size_t frame) {
    return render::frame_time(0.0, static_cast<long>(frame), margin.fps);
}

std::vector<double> slacks(const Margin& margin) {
    std::vector<double> list;
    for (std::size_t k = 0; k < margin.total.size(); ++k) list.push_back(margin.slack(k));
    std::sort(list.begin(), list.end());
    return list;
}

std::string margin_lead(const Margin& margin) {
    return fmt::format("{} of {:.3f} ms ({} fps{}), {} missed", counted(margin.total.size(), "frame"),
                       margin.budget_ms, margin.fps,
                       margin.rendered ? fmt::format(", {}x{}", margin.size.width, margin.size.height)
                                       : std::string(", simulation only"),
                       margin.missed);
}

/// Percentiles of every stage that was measured, and of whole frames.
Table stages_table(const Margin& margin) {
    Table stages(Column("stage", "", "<14"), Column("p50", "p50", ">10.4f"), Column("p95", "p95", ">10.4f"),
                 Column("p99", "p99", ">10.4f"), Column("max", "max", ">10.4f"),
                 Column("", "   ms per frame", "<"));
    const auto add = [&stages](const std::string& title, const std::vector<double>& values) {
        const Spread v = spread(values);
        stages.add({"  " + title, v.p50, v.p95, v.p99, v.max});
    };
    for (std::size_t s = 0; s < kMarginStages; ++s) {
        const std::string title = name(static_cast<MarginStage>(s));
        if (margin.has(s)) add(is_part_of_simulate(s) ? "  " + title : title, margin.stage[s]);
    }
    add("all", margin.total);
    return stages;
}

/// What the report says below its table, a line each.
std::string margin_sentences(const Margin& margin, const MarginRun& last) {
    fmt::memory_buffer out;
    const auto line = std::back_inserter(out);
    const double p99 = spread(margin.total).p99;
    const std::vector<double> slack = slacks(margin);
    fmt::format_to(line,
                   "At p99 a frame takes {:.1f} % of its time: margin {:.3f} ms. Slack: median {:.1f} %, "
                   "least {:.1f} %.\n",
                   100.0 * p99 / margin.budget_ms, margin.budget_ms - p99, median(slack), slack.front());
    if (margin.rendered)
        fmt::format_to(line,
                       "Without encoding and writing, {} would be missed. Of a picture {:.1f} % were encoded "
                       "anew (median; p99 "
                       "{:.1f} %).\n",
                       counted(static_cast<std::size_t>(margin.missed_shown), "frame"),
                       100.0 * spread(margin.encoded_share).p50, 100.0 * spread(margin.encoded_share).p99);
    if (margin.runs > 1)
        fmt::format_to(
            line,
            "Medians of {} runs; from run to run p50 {:.3f} to {:.3f} ms, p99 {:.3f} to {:.3f} ms, "
            "missed {:.0f} to {:.0f}; a frame varies by {:.0f} % (median).\n",
            margin.runs, margin.p50_runs.low, margin.p50_runs.high, margin.p99_runs.low, margin.p99_runs.high,
            margin.missed_runs.low, margin.missed_runs.high, 100.0 * margin.frame_spread);
    fmt::format_to(line, "The parts add up to {:.1f} % of the {:.1f} ms on the wall, one after the other.\n",
                   100.0 * margin.accounting.share(), margin.accounting.wall_ms);
    fmt::format_to(
        line,
        "Timing itself: simulating takes {:.3f} ms with it, {:.3f} ms without ({:+.1f} %; a look at "
        "the clock is {:.0f} ns). Off, it is not in the loop.\n",
        margin.timing.profiled_ms, margin.timing.plain_ms, 100.0 * margin.timing.share(),
        margin.timing.clock_ns);
    const std::vector<std::size_t>& events = last.frames[margin.worst].events;
    fmt::format_to(line, "worst frame: {} at {:.4f} s, {:.3f} ms, {}\n", margin.worst,
                   time_of(margin, margin.worst), margin.total[margin.worst],
                   counted(events.size(), "event"));
    for (const std::size_t i : events) {
        const Event& event = last.record.events[i];
        fmt::format_to(line, "  {:.6f} s  {:<21} {} {}\n", event.time, name(event.type),
                       last.record.tracks.at(event.a).id, last.record.partner_id(event));
    }
    return fmt::to_string(out);
}

/// A row for each frame.
Table frames_table(const Margin& margin, const MarginRun& last) {
    Table table(Column("frame"), Column("time"), Column("events"));
    for (std::size_t s = 0; s < kMarginStages; ++s)
        if (margin.has(s))
            table.columns.emplace_back(fmt::format("{}_ms", name(static_cast<MarginStage>(s))));
    for (const char* key : {"total_ms", "slack_percent", "missed"}) table.columns.emplace_back(key);
    for (std::size_t k = 0; k < margin.total.size(); ++k) {
        std::vector<Cell> cells = {k, time_of(margin, k), last.frames[k].events.size()};
        for (std::size_t s = 0; s < kMarginStages; ++s)
            if (margin.has(s)) cells.emplace_back(margin.stage[s][k]);
        for (const Cell& cell :
             {Cell(margin.total[k]), Cell(margin.slack(k)), Cell(margin.total[k] > margin.budget_ms)})
            cells.push_back(cell);
        table.add(std::move(cells));
    }
    return table;
}

}  // namespace

std::string margin_json(const Margin& margin, const MarginRun& last) {
    Json stages = Json::object();
    for (std::size_t s = 0; s < kMarginStages; ++s) {
        // A stage that was not measured is null and not 0.
        stages[name(static_cast<MarginStage>(s))] =
            margin.has(s) ? spread_json(margin.stage[s]) : Json(nullptr);
    }
    Json events = Json::array();
    for (const std::size_t i : last.frames[margin.worst].events) events.push_back(event_json(last.record, i));
    const std::vector<double> slack = slacks(margin);
    Json all = {{"fps", margin.fps},
                {"budget_ms", margin.budget_ms},
                {"frames", margin.total.size()},
                {"missed", margin.missed}};
    if (margin.rendered) {
        all["size"] = {margin.size.width, margin.size.height};
        all["missed_without_files"] = margin.missed_shown;
        all["encoded_share"] = spread_json(margin.encoded_share);
    }
    all["stages"] = stages;
    all["total"] = spread_json(margin.total);
    all["slack_percent"] = {{"least", slack.front()}, {"median", median(slack)}};
    all["worst"] = {{"frame", margin.worst},
                    {"time", time_of(margin, margin.worst)},
                    {"ms", margin.total[margin.worst]},
                    {"events", events}};
    all["runs"] = {{"count", margin.runs},
                   {"p50", {margin.p50_runs.low, margin.p50_runs.high}},
                   {"p99", {margin.p99_runs.low, margin.p99_runs.high}},
                   {"missed", {margin.missed_runs.low, margin.missed_runs.high}},
                   {"frame_spread", margin.frame_spread}};
    all["serial"] = {{"wall_ms", margin.accounting.wall_ms},
                     {"parts_ms", margin.accounting.parts_ms},
                     {"share", margin.accounting.share()}};
    all["timing"] = {{"clock_ns", margin.timing.clock_ns},
                     {"simulate_ms", margin.timing.plain_ms},
                     {"simulate_timed_ms", margin.timing.profiled_ms},
                     {"share", margin.timing.share()}};
    return all.dump() + "\n";
}

std::string margin_text(const Margin& margin, const MarginRun& last, const std::string& scene) {
    return fmt::format("{}: {}\n\n{}\n{}", scene, margin_lead(margin), table_text(stages_table(margin)),
                       margin_sentences(margin, last));
}

std::string margin_csv(const Margin& margin, const MarginRun& last) {
    return table_csv(frames_table(margin, last));
}

Report margin_report(const Margin& margin, const MarginRun& last, const std::string& scene) {
    Report report{"Margin of " + scene, margin_lead(margin), {}, {}, {}};
    std::istringstream sentences(margin_sentences(margin, last));
    for (std::string sentence; std::getline(sentences, sentence);) report.notes.push_back(sentence);
    report.charts = {margin_chart(margin, last, scene).dump()};
    report.tables = {sorted_table_json("Stages, ms per frame", stages_table(margin)).dump(),
                     sorted_table_json("Frames", frames_table(margin, last)).dump()};
    return report;
}

Plot margin_plot(const Margin& margin, const MarginRun& last, const std::string& scene) {
    Plot plot;
    plot.title = fmt::format("What each frame costs: {} at {} fps", scene, margin.fps);
    plot.notes = {fmt::format("{}{} of {} frames missed; strokes below: contacts",
                              margin.rendered ? fmt::format("{}x{}; ", margin.size.width, margin.size.height)
                                              : std::string("simulation only; "),
                              margin.missed, margin.total.size())};
    plot.x = {"time of the shot, s", false, 0.0, {}};
    plot.y = {"ms", true, {}, {}};
    const auto add = [&](const char* title, const std::vector<double>& values, int colour, bool line = true) {
        Series series{title, {}, line, !line, false, colour};
        for (std::size_t k = 0; k < values.size(); ++k)
            series.points.emplace_back(time_of(margin, k), values[k]);
        plot.series.push_back(series);
    };
    if (margin.rendered) {
        add("whole frame", margin.total, 6);
        add("encode", margin.stage[kEncode], 7);
        add("draw", margin.stage[kDraw], 0);
    }
    add("simulate (where not 0)", margin.stage[kSimulate], 1, false);
    plot.levels = {{fmt::format("1/{} s", margin.fps), margin.budget_ms}};
    constexpr std::array kKinds = {EventType::kBallBall, EventType::kBallCluster, EventType::kBallCushion,
                                   EventType::kBallPocket};
    for (const EventType kind : kKinds) {
        Ticks ticks{name(kind), {}};
        for (const Event& event : last.record.events)
            if (event.type == kind) ticks.at.push_back(event.time);
        if (!ticks.at.empty()) plot.ticks.push_back(ticks);
    }
    return plot;
}

Json margin_chart(const Margin& margin, const MarginRun& last, const std::string& scene) {
    Json chart = chart_json(margin_plot(margin, last, scene));
    chart["x"]["unit"] = "s";
    chart["marks"] = {
        {{"x", time_of(margin, margin.worst)},
         {"y", margin.total[margin.worst]},
         {"name", fmt::format("worst frame: {}, {:.3f} ms", margin.worst, margin.total[margin.worst])}}};
    return chart;
}

std::string margin_trace(const MarginRun& run, double fps) {
    constexpr double kUs = 1000.0;  // a trace is in microseconds
    Json events = Json::array();
    const auto span = [&events](const std::string& title, const char* category, double at, double ms,
                                const Json& args) {
        events.push_back({{"name", title},
                          {"cat", category},
                          {"ph", "X"},
                          {"ts", at},
                          {"dur", ms * kUs},
                          {"pid", 1},
                          {"tid", 1},
                          {"args", args}});
    };
    double free = 0.0;
    for (std::size_t k = 0; k < run.frames.size(); ++k) {
        const double start = std::max(free, render::frame_time(0.0, static_cast<long>(k), fps) * 1e6);
        double at = start;
        span(fmt::format("frame {}", k), "frame", start, run.total(k), {{"budget_ms", 1000.0 / fps}});
        span("simulate", "simulate", at, run.stage[kSimulate][k], {{"events", run.frames[k].events.size()}});
        double inside = at;
        if (k == 0) inside += run.record.setup_detect_ns * 1e-3;
        for (const std::size_t i : run.frames[k].events) {
            const EventCost& cost = run.record.costs.at(i);
            const double ms = (cost.detect_ns + cost.resolve_ns) * 1e-6;
            span(name(run.record.events[i].type), "event", inside, ms, event_json(run.record, i));
            inside += ms * kUs;
        }
        at += run.stage[kSimulate][k] * kUs;
        for (std::size_t s = kDraw; s < kMarginStages; ++s) {
            if (k >= run.stage[s].size()) continue;
            span(name(static_cast<MarginStage>(s)), "render", at, run.stage[s][k], Json::object());
            at += run.stage[s][k] * kUs;
        }
        free = at;
    }
    return Json{{"traceEvents", events}, {"displayTimeUnit", "ms"}}.dump() + "\n";
}

}  // namespace carom::tools
