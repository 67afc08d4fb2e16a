#include "report/html.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/machine.h"
#include "console.h"
#include "page/page.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;

/// Rounds to five significant digits. What is not finite becomes null.
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

Json series_json(const Series& series) {
    Json points = Json::array();
    for (const auto& [x, y] : series.points) points.push_back({rounded(x), rounded(y)});
    return {{"name", series.name}, {"points", points},        {"line", series.line},
            {"dots", series.dots}, {"dashed", series.dashed}, {"colour", series.colour}};
}

}  // namespace

Json chart_json(const Plot& plot, bool by_point) {
    Json json = {{"title", plot.title},    {"notes", plot.notes},    {"x", axis_json(plot.x)},
                 {"y", axis_json(plot.y)}, {"byPoint", by_point},    {"series", Json::array()},
                 {"ticks", Json::array()}, {"levels", Json::array()}};
    for (const Series& series : plot.series) json["series"].push_back(series_json(series));
    for (const Ticks& ticks : plot.ticks) {
        Json at = Json::array();
        for (const double x : ticks.at) at.push_back(rounded(x));
        json["ticks"].push_back({{"name", ticks.name}, {"at", at}});
    }
    for (const Level& level : plot.levels) json["levels"].push_back({{"name", level.name}, {"y", level.y}});
    return json;
}

Json sorted_table_json(const std::string& title, const Table& table) {
    Json columns = Json::array();
    for (const Column& column : table.columns)
        if (!column.key.empty()) columns.push_back({{"title", column.key}});
    Json rows = Json::array();
    for (const Table::Row& row : table.rows) {
        Json values = Json::array();
        for (std::size_t i = 0; i < row.cells.size(); ++i)
            if (!table.columns[i].key.empty()) values.push_back(cell_json(row.cells[i]));
        while (values.size() < columns.size()) values.push_back(nullptr);
        if (!row.note.empty()) values.push_back(row.note);
        rows.push_back(values);
    }
    return {{"title", title}, {"columns", columns}, {"rows", rows}};
}

Json page_json(const std::string& title, const std::string& lead) {
    return {{"title", title},
            {"lead", lead},
            {"command", command_line()},
            {"machine", fmt::format("carom {} on {}", program_version(), processor())}};
}

void write_html_report(const Report& report, const std::string& path) {
    if (path.empty()) return;
    Json page = page_json(report.title, report.lead);
    page["notes"] = report.notes;
    for (const auto& [key, list] :
         {std::pair("charts", &report.charts), std::pair("tables", &report.tables)}) {
        page[key] = Json::array();
        for (const std::string& item : *list) page[key].push_back(Json::parse(item));
    }
    write_report(path, page_html(report.title, {"dom.js", "chart.js", "table.js", "report.js"},
                                 {{"page", page.dump(-1, ' ', false, Json::error_handler_t::replace)}}));
}

}  // namespace carom::tools
