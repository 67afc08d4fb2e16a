#include "page/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;

/// Rounds to five significant digits; a value that is not finite becomes null.
Json rounded(double x) {
    if (!std::isfinite(x)) return nullptr;
    return std::strtod(fmt::format("{:.5g}", x).c_str(), nullptr);
}

Json axis_json(const Axis& axis) {
    Json json = {{"title", axis.title}, {"log", axis.logarithmic}};
    if (axis.low) json["low"] = *axis.low;
    if (axis.high) json["high"] = *axis.high;
    if (!axis.marks.empty()) {
        json["marks"] = Json::array();
        for (const auto& [value, words] : axis.marks) json["marks"].push_back({value, words});
    }
    return json;
}

/// Points are [x, y], or y alone if the first series has the same x: half of a page's chart.
Json series_json(const Series& series, const Series& first) {
    const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
    const bool shared = &series != &first && std::equal(series.points.begin(), series.points.end(),
                                                        first.points.begin(), first.points.end(), same);
    Json points = Json::array();
    for (const auto& [x, y] : series.points)
        points.push_back(shared ? rounded(y) : Json{rounded(x), rounded(y)});
    return {{"name", series.name}, {"points", points},        {"line", series.line},
            {"dots", series.dots}, {"dashed", series.dashed}, {"colour", series.colour}};
}

}  // namespace

Json chart_json(const Plot& plot, bool by_point) {
    Json json = {{"title", plot.title},    {"notes", plot.notes},    {"x", axis_json(plot.x)},
                 {"y", axis_json(plot.y)}, {"byPoint", by_point},    {"series", Json::array()},
                 {"ticks", Json::array()}, {"levels", Json::array()}};
    for (const Series& series : plot.series)
        json["series"].push_back(series_json(series, plot.series.front()));
    for (const Ticks& ticks : plot.ticks) {
        Json at = Json::array();
        for (const double x : ticks.at) at.push_back(rounded(x));
        json["ticks"].push_back({{"name", ticks.name}, {"at", at}});
    }
    for (const Level& level : plot.levels) json["levels"].push_back({{"name", level.name}, {"y", level.y}});
    return json;
}

}  // namespace carom::tools
