// carom margin: the command.
#include "commands/margin/margin.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "base/clock.h"
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

namespace {

using Json = nlohmann::ordered_json;

Json spread_json(const std::vector<double>& values) {
    const Spread v = spread(values);
    return {{"p50", v.p50}, {"p95", v.p95}, {"p99", v.p99}, {"max", v.max}};
}

Json json_of(const Range& range) {
    return {range.low, range.high};
}

/// "0.101 to 0.113", or "0.101" of a single run.
std::string text_of(const Range& range) {
    return range.low == range.high ? fmt::format("{:.3f}", range.low)
                                   : fmt::format("{:.3f} to {:.3f}", range.low, range.high);
}

std::string text_of(const RunTotals& runs, bool rendered) {
    std::string text = fmt::format("p50 {}, p99 {}, max {} ms; missed {:.0f} to {:.0f}; ", text_of(runs.p50),
                                   text_of(runs.p99), text_of(runs.max), runs.missed.low, runs.missed.high);
    if (rendered) text += fmt::format("set-up {} ms; ", text_of(runs.setup_ms));
    return text + fmt::format("frame 0 {} ms\n", text_of(runs.frame_0_ms));
}

Json json_of(const RunTotals& runs) {
    return {{"p50", json_of(runs.p50)},           {"p99", json_of(runs.p99)},
            {"max", json_of(runs.max)},           {"missed", json_of(runs.missed)},
            {"setup_ms", json_of(runs.setup_ms)}, {"frame_0_ms", json_of(runs.frame_0_ms)}};
}

std::vector<double> slacks(const Margin& margin) {
    std::vector<double> list;
    for (std::size_t k = 0; k < margin.total.size(); ++k) list.push_back(margin.slack(k));
    std::sort(list.begin(), list.end());
    return list;
}

}  // namespace

Json event_cost_json(const Record& record, std::size_t i) {
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

std::string margin_lead(const Margin& margin) {
    return fmt::format("{} of {:.3f} ms ({} fps{}), {} missed", counted(margin.total.size(), "frame"),
                       margin.budget_ms, margin.fps,
                       margin.rendered ? fmt::format(", {}x{}", margin.size.width, margin.size.height)
                                       : std::string(", simulation only"),
                       margin.missed);
}

Table stages_table(const Margin& margin) {
    Table stages(Column("stage", "", "<14"), Column("p50", "p50", ">10.4f"), Column("p95", "p95", ">10.4f"),
                 Column("p99", "p99", ">10.4f"), Column("max", "max", ">10.4f"),
                 Column("", "   ms per frame", "<"));
    const auto add = [&stages](const std::string& title, const std::vector<double>& values,
                               const std::string& note = "") {
        const Spread v = spread(values);
        stages.add({"  " + title, v.p50, v.p95, v.p99, v.max}, note);
    };
    for (std::size_t s = 0; s < kMarginStages; ++s) {
        const std::string title = name(static_cast<MarginStage>(s));
        if (margin.has(s)) add(is_part_of_simulate(s) ? "  " + title : title, margin.stage[s]);
    }
    add("all", margin.total,
        margin.runs > 1 ? fmt::format("   {} runs: p99 {}, max {}", margin.runs, text_of(margin.all.p99),
                                      text_of(margin.all.max))
                        : "");
    return stages;
}

std::string margin_sentences(const Margin& margin, const MarginRun& last) {
    fmt::memory_buffer out;
    const auto line = std::back_inserter(out);
    const double p99 = spread(margin.total).p99;
    const std::vector<double> slack = slacks(margin);
    fmt::format_to(line,
                   "At p99 a frame takes {:.1f} % of its budget and leaves {:.3f} ms. Slack: median {:.1f} "
                   "%, minimum {:.1f} %.\n",
                   100.0 * p99 / margin.budget_ms, margin.budget_ms - p99, median(slack), slack.front());
    if (margin.rendered)
        fmt::format_to(line,
                       "Without encoding and writing, {} would be missed. {:.1f} % of a picture is encoded "
                       "anew (median; p99 {:.1f} %).\n",
                       counted(static_cast<std::size_t>(margin.missed_shown), "frame"),
                       100.0 * spread(margin.encoded_share).p50, 100.0 * spread(margin.encoded_share).p99);
    fmt::format_to(line, "first run: {}", text_of(margin.first, margin.rendered));
    if (margin.runs > 1)
        fmt::format_to(line, "warm runs: {}Medians of {} runs; a frame varies by {:.0f} % (median).\n",
                       text_of(margin.warm, margin.rendered), margin.runs, 100.0 * margin.frame_spread);
    fmt::format_to(line, "{} of {} have no event.\n", margin.quiet, counted(margin.total.size(), "frame"));
    const Accounting& sum = margin.accounting;
    fmt::format_to(
        line,
        "Start {:.1f}, set-up {:.1f}, frame 0 {:.1f}, other frames {:.1f} and cost of timing {:.1f} "
        "ms add up to {:.1f} % of the {:.1f} ms of the process.\n",
        sum.start_ms, sum.setup_ms, sum.first_frames_ms, sum.frames_ms, sum.timing_ms, 100.0 * sum.share(),
        sum.wall_ms);
    fmt::format_to(line,
                   "Cost of timing: the simulation takes {:.3f} ms with it, {:.3f} ms without ({:+.1f} %; "
                   "{:.0f} ns per clock reading). Without profiling, the loop contains no timing.\n",
                   margin.timing.profiled_ms, margin.timing.plain_ms, 100.0 * margin.timing.share(),
                   margin.timing.clock_ns);
    const std::vector<std::size_t>& events = last.frames[margin.worst].events;
    fmt::format_to(line, "worst frame: {} at {:.4f} s, {:.3f} ms, {}\n", margin.worst,
                   margin.time(margin.worst), margin.total[margin.worst], counted(events.size(), "event"));
    for (const std::size_t i : events) {
        const Event& event = last.record.events[i];
        fmt::format_to(line, "  {:.6f} s  {:<21} {} {}\n", event.time, name(event.type),
                       last.record.tracks.at(event.a).id, last.record.partner_id(event));
    }
    return fmt::to_string(out);
}

Table frames_table(const Margin& margin, const MarginRun& last) {
    Table table(Column("frame"), Column("time"), Column("events"));
    for (std::size_t s = 0; s < kMarginStages; ++s)
        if (margin.has(s))
            table.columns.emplace_back(fmt::format("{}_ms", name(static_cast<MarginStage>(s))));
    for (const char* key : {"total_ms", "slack_percent", "missed"}) table.columns.emplace_back(key);
    for (std::size_t k = 0; k < margin.total.size(); ++k) {
        std::vector<Cell> cells = {k, margin.time(k), last.frames[k].events.size()};
        for (std::size_t s = 0; s < kMarginStages; ++s)
            if (margin.has(s)) cells.emplace_back(margin.stage[s][k]);
        for (const Cell& cell :
             {Cell(margin.total[k]), Cell(margin.slack(k)), Cell(margin.total[k] > margin.budget_ms)})
            cells.push_back(cell);
        table.add(std::move(cells));
    }
    return table;
}

std::string margin_json(const Margin& margin, const MarginRun& last) {
    Json stages = Json::object();
    for (std::size_t s = 0; s < kMarginStages; ++s) {
        // A stage that was not measured is null, not 0.
        stages[name(static_cast<MarginStage>(s))] =
            margin.has(s) ? spread_json(margin.stage[s]) : Json(nullptr);
    }
    Json events = Json::array();
    for (const std::size_t i : last.frames[margin.worst].events)
        events.push_back(event_cost_json(last.record, i));
    const std::vector<double> slack = slacks(margin);
    Json all = {{"fps", margin.fps},
                {"budget_ms", margin.budget_ms},
                {"frames", margin.total.size()},
                {"missed", margin.missed},
                {"without_event", margin.quiet}};
    if (margin.rendered) {
        all["size"] = {margin.size.width, margin.size.height};
        all["missed_without_files"] = margin.missed_shown;
        all["encoded_share"] = spread_json(margin.encoded_share);
    }
    all["stages"] = stages;
    all["total"] = spread_json(margin.total);
    all["slack_percent"] = {{"least", slack.front()}, {"median", median(slack)}};
    all["worst"] = {{"frame", margin.worst},
                    {"time", margin.time(margin.worst)},
                    {"ms", margin.total[margin.worst]},
                    {"events", events}};
    all["runs"] = {{"count", margin.runs},
                   {"p50", json_of(margin.all.p50)},
                   {"p99", json_of(margin.all.p99)},
                   {"max", json_of(margin.all.max)},
                   {"missed", json_of(margin.all.missed)},
                   {"frame_spread", margin.frame_spread},
                   {"first", json_of(margin.first)}};
    if (margin.runs > 1) all["runs"]["warm"] = json_of(margin.warm);
    const Accounting& sum = margin.accounting;
    all["process"] = {{"wall_ms", sum.wall_ms},     {"start_ms", sum.start_ms},
                      {"setup_ms", sum.setup_ms},   {"first_frames_ms", sum.first_frames_ms},
                      {"frames_ms", sum.frames_ms}, {"timing_ms", sum.timing_ms},
                      {"parts_ms", sum.parts_ms()}, {"share", sum.share()}};
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

}  // namespace carom::tools
