// A table of results: one list of columns, written as aligned text, as CSV or as JSON.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace carom::tools {

/// One value: nothing, a boolean, a count, a number or a text. In the text form `text` replaces it,
/// unless it is empty.
struct Cell {
    Cell() = default;
    template <class T>
    Cell(const T& of, std::string shown = "")
        : text(std::move(shown)) {  // NOLINT(google-explicit-constructor)
        if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>)
            value = static_cast<std::int64_t>(of);
        else if constexpr (std::is_arithmetic_v<T>)
            value = of;
        else
            value = std::string(of);
    }

    std::variant<std::monostate, bool, std::int64_t, double, std::string> value;
    std::string text;
};

/// `key` is the name in CSV and JSON, `title` the heading in the text. `format` is the fmt format in the
/// text: alignment, width and number form, ">8.2f". A column without a key is only in the text; one without a
/// format is not in the text.
struct Column {
    explicit Column(std::string of_key, std::string of_title = "", std::string of_format = "",
                    bool is_in_csv = true)
        : key(std::move(of_key)),
          title(std::move(of_title)),
          format(std::move(of_format)),
          in_csv(is_in_csv) {}
    std::string key, title, format;
    bool in_csv;
};

/// A row may have fewer values than columns, for example after a failed measurement. Text and JSON then
/// contain those values, and CSV omits the row.
struct Table {
    template <class... Columns>
    explicit Table(Columns... list) : columns{std::move(list)...} {}

    struct Row {
        std::vector<Cell> cells;
        std::string note;  ///< printed after the row in the text
    };
    void add(std::vector<Cell> cells, std::string note = "") {
        rows.push_back({std::move(cells), std::move(note)});
    }

    std::vector<Column> columns;
    std::vector<Row> rows;
};

/// Titles and rows, one line each. A missing value is "-".
std::string table_text(const Table& table);

/// Keys and rows, one line each. Numbers read back to the same bits; booleans are 1 or 0; texts are quoted if
/// CSV needs it, and control characters in them become spaces.
std::string table_csv(const Table& table);
std::string csv_line(const std::vector<Cell>& cells);
/// Appends one value in the form of csv_line(), and a comma.
void append_csv(std::string& line, double x);
void append_csv(std::string& line, std::int64_t count);
void append_csv(std::string& line, std::string_view words);

/// One value as JSON; null if there is none.
nlohmann::ordered_json cell_json(const Cell& cell);

/// A list of objects. A value that is missing or not finite is null.
nlohmann::ordered_json table_json(const Table& table);

/// Writes text to a file, unless its name is empty. @throws std::runtime_error
void write_report(const std::string& path, const std::string& text);

}  // namespace carom::tools
