// Reports as pages: charts that can be read by hovering, tables that sort, and what they come from.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "report/plot.h"
#include "report/table.h"

namespace carom::tools {

/// What tools/carom/page/chart.js draws. Values have five significant digits, far below a pixel.
/// @param by_point  the reader looks at single points, not at all series at one x
nlohmann::ordered_json chart_json(const Plot& plot, bool by_point = false);

/// What tools/carom/page/table.js shows: the columns that have a key. Rows that lack values keep their note.
nlohmann::ordered_json sorted_table_json(const std::string& title, const Table& table);

/// What every page says about itself: title, the command that made it, program and machine.
nlohmann::ordered_json page_json(const std::string& title, const std::string& lead);

struct Report {
    std::string title, lead;
    std::vector<std::string> notes;           ///< sentences
    std::vector<std::string> charts, tables;  ///< JSON of chart_json() and sorted_table_json()
};

/// Written under a temporary name and renamed; nothing if the path is empty. @throws std::runtime_error naming the file
void write_html_report(const Report& report, const std::string& path);

}  // namespace carom::tools
