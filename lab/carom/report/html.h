// Reports as pages: charts with values on hover, sortable tables, and their sources.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/options.h"
#include "report/table.h"

namespace carom::tools {

/// A table as page/table.js shows it: the columns that have a key. Rows without values keep their note.
nlohmann::ordered_json sorted_table_json(const std::string& title, const Table& table);

void add_html(Options& command, std::string& html);

struct Report {
    std::string title, lead;
    std::vector<std::string> notes;
    /// JSON of chart_json() and sorted_table_json().
    std::vector<std::string> charts, tables;
};

/// Written under a temporary name and renamed; not written if the path is empty. @throws std::runtime_error
/// naming the file
void write_html_report(const Report& report, const std::string& path);

}  // namespace carom::tools
