// carom margin: how much of 1/fps every frame leaves over.
//
// Stages: simulate (detect and resolve of the events in the frame's interval), kernel (the part of simulate
// inside impact kernels, not counted twice), draw, readback, encode. A frame costs simulate + draw + readback
// + encode.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "carom/engine/output_file.h"
#include "carom/render/sequence.h"
#include "commands.h"
#include "console.h"
#include "csv.h"
#include "frame_costs.h"
#include "setup.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;

enum Stage : std::size_t { kSimulate, kKernel, kDraw, kReadback, kEncode, kStages };
constexpr const char* kStageNames[kStages] = {"simulate", "kernel", "draw", "readback", "encode"};

/// Costs of every frame in ms, one list per stage; and of the whole frame.
struct Margin {
    double fps = 60.0;
    double budget_ms = 0.0;
    bool rendered = true;
    std::vector<double> stage[kStages];
    std::vector<double> total;
    std::vector<FrameCost> frames;  ///< of the last run: its events
    long missed = 0;
    std::size_t worst = 0;

    bool has(std::size_t s) const { return rendered || s <= kKernel; }
};

/// One run's costs, frame by frame, into column `run` of samples[stage][frame].
using Samples = std::vector<std::vector<double>>;

void add_run(const std::vector<FrameCost>& simulated, const std::vector<render::FrameTiming>& drawn,
             Samples* samples) {
    for (std::size_t k = 0; k < simulated.size(); ++k) {
        samples[kSimulate][k].push_back(simulated[k].simulate_ms);
        samples[kKernel][k].push_back(simulated[k].kernel_ms);
        if (k >= drawn.size()) continue;
        samples[kDraw][k].push_back(drawn[k].draw_ms);
        samples[kReadback][k].push_back(drawn[k].readback_ms);
        samples[kEncode][k].push_back(drawn[k].encode_ms);
    }
}

std::vector<render::FrameTiming> draw(const Record& record, const MarginArgs& args, double fps,
                                      const std::string& title) {
    const RenderSettings& settings = record.render;
    render::SequenceOptions options;
    options.pattern.clear();  // encoded and thrown away: a disk is not what is measured
    options.fps = fps;
    options.size =
        args.size.empty() ? render::FrameSize{settings.width, settings.height} : parse_size(args.size);
    options.camera = settings.camera;
    options.backend = render::backend_from_name(args.gl);
    ProgressLine line(title);
    options.progress = [&line](long done, long total) {
        throw_if_interrupted();
        line.show_bar(done, total);
    };
    return render::render_sequence(record, options);
}

Margin measure(const Plan& plan, const MarginArgs& args, Record& record) {
    Margin margin;
    margin.rendered = !args.no_render;
    Samples samples[kStages];
    for (int run = 0; run < args.repeat; ++run) {
        SimulateOptions options;
        options.profile = true;
        record = simulate_plan(plan, options);
        margin.fps = chosen_fps(args.fps, record.render);
        const long frames = checked_frame_count(0.0, record.duration, margin.fps);
        margin.frames = costs_by_frame(record, 0.0, margin.fps, frames);
        for (Samples& s : samples) s.resize(margin.frames.size());
        std::vector<render::FrameTiming> drawn;
        if (margin.rendered)
            drawn = draw(record, args, margin.fps, fmt::format("run {} of {}:", run + 1, args.repeat));
        throw_if_interrupted();
        add_run(margin.frames, drawn, samples);
    }
    margin.budget_ms = 1000.0 / margin.fps;
    for (std::size_t s = 0; s < kStages; ++s) {
        for (const std::vector<double>& runs : samples[s])
            margin.stage[s].push_back(runs.empty() ? 0.0 : median(runs));
    }
    for (std::size_t k = 0; k < margin.frames.size(); ++k) {
        const double ms = margin.stage[kSimulate][k] + margin.stage[kDraw][k] + margin.stage[kReadback][k] +
                          margin.stage[kEncode][k];
        margin.total.push_back(ms);
        if (ms > margin.budget_ms) ++margin.missed;
        if (ms > margin.total[margin.worst]) margin.worst = k;
    }
    return margin;
}

struct Spread {
    double p50, p95, p99, max;
};

Spread spread(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return {percentile(values, 50.0), percentile(values, 95.0), percentile(values, 99.0), values.back()};
}

Json event_json(const Record& record, std::size_t i) {
    const Event& event = record.events[i];
    const EventCost& cost = record.costs.at(i);
    return {{"time", event.time},
            {"type", name(event.type)},
            {"a", record.tracks.at(static_cast<std::size_t>(event.a)).id},
            {"b", record.partner_id(event)},
            {"detect_ns", cost.detect_ns},
            {"resolve_ns", cost.resolve_ns},
            {"kernel_ns", cost.kernel_ns}};
}

std::string margin_json(const Margin& margin, const Record& record) {
    Json stages = Json::object();
    for (std::size_t s = 0; s < kStages; ++s) {
        if (!margin.has(s)) {
            stages[kStageNames[s]] = nullptr;  // not measured is not 0
            continue;
        }
        const Spread v = spread(margin.stage[s]);
        stages[kStageNames[s]] = {{"p50", v.p50}, {"p95", v.p95}, {"p99", v.p99}, {"max", v.max}};
    }
    Json events = Json::array();
    for (const std::size_t i : margin.frames[margin.worst].events) events.push_back(event_json(record, i));
    const Json all = {{"fps", margin.fps},
                      {"budget_ms", margin.budget_ms},
                      {"frames", margin.total.size()},
                      {"missed", margin.missed},
                      {"stages", stages},
                      {"worst",
                       {{"frame", margin.worst},
                        {"time", render::frame_time(0.0, static_cast<long>(margin.worst), margin.fps)},
                        {"ms", margin.total[margin.worst]},
                        {"events", events}}}};
    return all.dump() + "\n";
}

std::string margin_text(const Margin& margin, const Record& record, const MarginArgs& args) {
    fmt::memory_buffer out;
    const auto line = std::back_inserter(out);
    fmt::format_to(line, "{}: {} frames of {:.3f} ms ({} fps), {} missed\n\n", args.scene,
                   margin.total.size(), margin.budget_ms, margin.fps, margin.missed);
    fmt::format_to(line, "  {:<10}{:>10}{:>10}{:>10}{:>10}   ms per frame\n", "", "p50", "p95", "p99", "max");
    const auto row = [&line](const char* title, const std::vector<double>& values) {
        const Spread v = spread(values);
        fmt::format_to(line, "  {:<10}{:>10.4f}{:>10.4f}{:>10.4f}{:>10.4f}\n", title, v.p50, v.p95, v.p99,
                       v.max);
    };
    for (std::size_t s = 0; s < kStages; ++s) {
        if (margin.has(s)) row(kStageNames[s], margin.stage[s]);
    }
    row("all", margin.total);
    std::vector<double> sorted = margin.total;
    std::sort(sorted.begin(), sorted.end());
    const double p99 = percentile(sorted, 99.0);
    fmt::format_to(
        line,
        "\nkernel is a part of simulate. At p99 a frame takes {:.1f} % of its time: margin {:.3f} ms.\n",
        100.0 * p99 / margin.budget_ms, margin.budget_ms - p99);
    const std::vector<std::size_t>& events = margin.frames[margin.worst].events;
    fmt::format_to(line, "worst frame: {} at {:.4f} s, {:.3f} ms, {} events\n", margin.worst,
                   render::frame_time(0.0, static_cast<long>(margin.worst), margin.fps),
                   margin.total[margin.worst], events.size());
    for (const std::size_t i : events) {
        const Event& event = record.events[i];
        fmt::format_to(line, "  {:.6f} s  {:<21} {} {}\n", event.time, name(event.type),
                       record.tracks.at(static_cast<std::size_t>(event.a)).id, record.partner_id(event));
    }
    return fmt::to_string(out);
}

void write_margin_csv(const Margin& margin, const std::string& path) {
    OutputFile file(path);
    file.write(margin.rendered
                   ? "frame,time,events,simulate_ms,kernel_ms,draw_ms,readback_ms,encode_ms,total_ms,missed\n"
                   : "frame,time,events,simulate_ms,kernel_ms,total_ms,missed\n");
    for (std::size_t k = 0; k < margin.total.size(); ++k) {
        std::string row =
            fmt::format("{},{},{}", k, render::frame_time(0.0, static_cast<long>(k), margin.fps),
                        margin.frames[k].events.size());
        for (std::size_t s = 0; s < kStages; ++s) {
            if (margin.has(s)) row += fmt::format(",{}", margin.stage[s][k]);
        }
        file.write(
            fmt::format("{},{},{}\n", row, margin.total[k], margin.total[k] > margin.budget_ms ? 1 : 0));
    }
    file.commit();
}

}  // namespace

int run_margin(const MarginArgs& args) {
    if (args.repeat < 1) throw UsageError("--repeat: expected at least 1");
    if (!args.size.empty()) parse_size(args.size);
    const Plan plan = plan_scene(args.scene);
    chosen_fps(args.fps, plan.scene.render);
    Record record;
    const Margin margin = measure(plan, args, record);
    if (!args.csv.empty()) write_margin_csv(margin, args.csv);
    print(args.json ? margin_json(margin, record) : margin_text(margin, record, args));
    return kOk;
}

}  // namespace carom::tools
