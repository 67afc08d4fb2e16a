#include "report/margin_chart.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace carom::tools {
namespace {

std::string worst_frame(const Margin& margin) {
    return fmt::format("worst frame: {}, {:.3f} ms", margin.worst, margin.total[margin.worst]);
}

// @param all  all stages, and the worst frame, which a page marks by itself
Plot plot_of(const Margin& margin, const MarginRun& last, const std::string& scene, bool all) {
    Plot plot;
    plot.title = fmt::format("Cost of each frame: {} at {} fps", scene, margin.fps);
    plot.notes = {fmt::format("{}{} of {} frames missed; ticks mark contacts",
                              margin.rendered ? fmt::format("{}x{}; ", margin.size.width, margin.size.height)
                                              : std::string("simulation only; "),
                              margin.missed, margin.total.size())};
    plot.x = {"time of the shot, s", false, 0.0, {}};
    plot.y = {"ms", true, {}, {}};
    const auto add = [&](const char* title, const std::vector<double>& values, int colour, bool line = true) {
        Series series{title, {}, line, !line, false, colour};
        for (std::size_t k = 0; k < values.size(); ++k) series.points.emplace_back(margin.time(k), values[k]);
        plot.series.push_back(series);
    };
    if (margin.rendered) {
        add("whole frame", margin.total, 6);
        add("encode", margin.stage[kEncode], 7);
        add("draw", margin.stage[kDraw], 0);
    }
    if (margin.rendered && all) {
        add("write", margin.stage[kWrite], 4);
        add("read back", margin.stage[kReadback], 5);
    }
    add("simulate (where not 0)", margin.stage[kSimulate], 1, false);
    const std::pair worst{margin.time(margin.worst), margin.total[margin.worst]};
    if (all) plot.series.push_back({worst_frame(margin), {worst}, false, true, false, 3});
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

}  // namespace

Plot margin_plot(const Margin& margin, const MarginRun& last, const std::string& scene) {
    return plot_of(margin, last, scene, true);
}

nlohmann::ordered_json margin_chart(const Margin& margin, const MarginRun& last, const std::string& scene) {
    nlohmann::ordered_json chart = chart_json(plot_of(margin, last, scene, false));
    chart["x"]["unit"] = "s";
    chart["marks"] = {
        {{"x", margin.time(margin.worst)}, {"y", margin.total[margin.worst]}, {"name", worst_frame(margin)}}};
    return chart;
}

}  // namespace carom::tools
