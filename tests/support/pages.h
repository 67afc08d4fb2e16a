// The pages in docs/ and the sources, for comparison with the program.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace carom::test {

/// A file of the source tree. @throws std::runtime_error
inline std::string read_source(const std::string& name) {
    std::ifstream in(std::string(CAROM_SOURCE_DIR) + "/" + name, std::ios::binary);
    if (!in) throw std::runtime_error("cannot read " + name);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// The cells of a line of a Markdown table.
inline std::vector<std::string> cells(const std::string& line) {
    std::vector<std::string> out;
    std::istringstream in(line.substr(1));
    for (std::string cell; std::getline(in, cell, '|');) {
        const std::size_t first = cell.find_first_not_of(' '), last = cell.find_last_not_of(' ');
        out.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
    }
    return out;
}

/// The texts in backticks.
inline std::vector<std::string> code(const std::string& text) {
    std::vector<std::string> out;
    for (std::size_t at = text.find('`'); at != std::string::npos;) {
        const std::size_t end = text.find('`', at + 1);
        if (end == std::string::npos) break;
        out.push_back(text.substr(at + 1, end - at - 1));
        at = text.find('`', end + 1);
    }
    return out;
}

/// The rows of all tables of a page, by the heading ("## ...") above them.
inline std::map<std::string, std::vector<std::vector<std::string>>> table_rows(const std::string& page) {
    std::map<std::string, std::vector<std::vector<std::string>>> rows;
    std::istringstream in(page);
    std::string heading;
    for (std::string line; std::getline(in, line);) {
        if (line.rfind("## ", 0) == 0)
            heading = line.substr(3);
        else if (!line.empty() && line[0] == '|' && !heading.empty())
            rows[heading].push_back(cells(line));
    }
    return rows;
}

}  // namespace carom::test
