#include "report/html.h"

#include <cstddef>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/console.h"
#include "carom/engine/printable.h"
#include "page/page.h"

namespace carom::tools {

using Json = nlohmann::ordered_json;

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

void add_html(Options& command, std::string& html) {
    command.option("--html", &html, "FILE.html", "The report as a page (default: not written)");
}

void write_html_report(const Report& report, const std::string& path) {
    if (path.empty()) return;
    Json page = page_json(report.title, report.lead, harmless(command_line()), program_version());
    page["notes"] = report.notes;
    for (const auto& [key, list] :
         {std::pair("charts", &report.charts), std::pair("tables", &report.tables)}) {
        page[key] = Json::array();
        for (const std::string& item : *list) page[key].push_back(Json::parse(item));
    }
    write_report(path, page_html(report.title, "report.js",
                                 {{"page", page.dump(-1, ' ', false, Json::error_handler_t::replace)}}));
}

}  // namespace carom::tools
