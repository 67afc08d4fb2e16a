// The frames of one run as Chrome trace events.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "carom/render/sequence.h"
#include "commands/margin/margin.h"
#include "margin/lab_margin.h"

namespace carom::tools {

using Json = nlohmann::ordered_json;

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
            span(name(run.record.events[i].type), "event", inside, ms, event_cost_json(run.record, i));
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
