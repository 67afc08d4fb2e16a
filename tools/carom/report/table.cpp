#include "report/table.h"

#include <algorithm>
#include <cstdint>
#include <iterator>

#include <fmt/compile.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/output_file.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;

/// The value as text; "" if there is none.
std::string plain(const Cell& cell) {
    if (const auto* words = std::get_if<std::string>(&cell.value)) return *words;
    if (const auto* count = std::get_if<std::int64_t>(&cell.value)) return fmt::format("{}", *count);
    if (const auto* x = std::get_if<double>(&cell.value)) return fmt::format("{}", *x);
    if (const auto* truth = std::get_if<bool>(&cell.value)) return *truth ? "1" : "0";
    return "";
}

std::string aligned(const Cell& cell, const std::string& format) {
    const auto* number = std::get_if<double>(&cell.value);
    if (number != nullptr && cell.text.empty())
        return fmt::format(fmt::runtime(fmt::format("{{:{}}}", format)), *number);
    const bool nothing = std::holds_alternative<std::monostate>(cell.value);
    const std::string text = !cell.text.empty() ? cell.text : nothing ? "-" : plain(cell);
    return fmt::format(fmt::runtime(fmt::format("{{:{}}}", format.substr(0, format.find('.')))), text);
}

}  // namespace

std::string table_text(const Table& table) {
    std::string out;
    for (const Column& column : table.columns)
        if (!column.format.empty()) out += aligned(column.title, column.format);
    out += '\n';
    for (const Table::Row& row : table.rows) {
        for (std::size_t i = 0; i < row.cells.size(); ++i)
            if (!table.columns[i].format.empty()) out += aligned(row.cells[i], table.columns[i].format);
        out += row.note + '\n';
    }
    return out;
}

void append_csv(std::string& line, double x) {
    char text[40];  // a double takes 24 characters
    line.append(text, fmt::format_to(text, FMT_COMPILE("{},"), x));
}

void append_csv(std::string& line, std::int64_t count) {
    line += fmt::format_int(count).c_str();
    line += ',';
}

void append_csv(std::string& line, std::string_view words) {
    const bool plain_words = std::none_of(words.begin(), words.end(), [](char c) {
        return c == ',' || c == '"' || static_cast<unsigned char>(c) < 0x20;
    });
    if (plain_words) {
        line += words;
        line += ',';
        return;
    }
    const bool quotes = words.find_first_of(",\"") != words.npos;
    if (quotes) line += '"';
    for (const char c : words) {
        if (c == '"') line += '"';
        line += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    line += quotes ? "\"," : ",";
}

std::string csv_line(const std::vector<Cell>& cells) {
    std::string line;
    for (const Cell& cell : cells) append_csv(line, plain(cell));
    line.back() = '\n';
    return line;
}

std::string table_csv(const Table& table) {
    const auto line = [&table](auto&& cell_of) {
        std::vector<Cell> cells;
        for (std::size_t i = 0; i < table.columns.size(); ++i)
            if (table.columns[i].in_csv && !table.columns[i].key.empty()) cells.push_back(cell_of(i));
        return csv_line(cells);
    };
    std::string out = line([&table](std::size_t i) { return table.columns[i].key; });
    for (const Table::Row& row : table.rows)
        if (row.cells.size() == table.columns.size())
            out += line([&row](std::size_t i) { return row.cells[i]; });
    return out;
}

nlohmann::ordered_json cell_json(const Cell& cell) {
    return std::visit(
        [](const auto& value) {
            if constexpr (std::is_same_v<decltype(value), const std::monostate&>)
                return Json(nullptr);
            else
                return Json(value);
        },
        cell.value);
}

nlohmann::ordered_json table_json(const Table& table) {
    Json list = Json::array();
    for (const Table::Row& row : table.rows) {
        Json object = Json::object();
        for (std::size_t i = 0; i < row.cells.size(); ++i)
            if (!table.columns[i].key.empty()) object[table.columns[i].key] = cell_json(row.cells[i]);
        list.push_back(object);
    }
    return list;
}

void write_report(const std::string& path, const std::string& text) {
    if (path.empty()) return;
    OutputFile file(path);
    file.write(text);
    file.commit();
}

}  // namespace carom::tools
