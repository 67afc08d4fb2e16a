#include "scene/reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace carom::detail {
namespace {

const char* type_name(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "an array";
        case toml::node_type::string:
            return "a string";
        case toml::node_type::integer:
            return "an integer";
        case toml::node_type::floating_point:
            return "a number";
        case toml::node_type::boolean:
            return "a boolean";
        default:
            return "a date or time";
    }
}

bool before(SourceLocation a, SourceLocation b) {
    return a.line != b.line ? a.line < b.line : a.column < b.column;
}

SourceLocation place(const toml::source_region& region) {
    return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

std::string describe(const Interval& i) {
    return fmt::format("{} {} and {} {}{}{}", i.low_open ? "more than" : "at least", i.low,
                       i.high_open ? "less than" : "at most", i.high, *i.unit ? " " : "", i.unit);
}

/// "a", "a or b", "a, b or c"
std::string listed(const std::vector<const char*>& names) {
    std::string out;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) out += i + 1 == names.size() ? " or " : ", ";
        out += names[i];
    }
    return out;
}

}  // namespace

SourceLocation place(const toml::node& node) {
    return place(node.source());
}

Section::Section(const toml::table& table, const std::string& file, std::string path,
                 std::initializer_list<std::string_view> keys)
    : table_(table),
      file_(file),
      path_(std::move(path)),
      where_(place(static_cast<const toml::node&>(table))) {
    // toml++ sorts its keys; report the unknown one that comes first in the file.
    const toml::key* unknown = nullptr;
    for (auto&& [key, value] : table) {
        if (std::find(keys.begin(), keys.end(), key.str()) != keys.end()) continue;
        if (!unknown || before(place(key.source()), place(unknown->source()))) unknown = &key;
    }
    if (!unknown) return;
    if (path_.empty()) {
        fail(place(unknown->source()),
             fmt::format("unknown section or key {}; the sections are {}", in_quotes(unknown->str()),
                         fmt::join(keys.begin(), keys.end(), ", ")));
    }
    fail(place(unknown->source()),
         fmt::format("unknown key {} in [{}]; the keys there are {}", in_quotes(unknown->str()), path_,
                     fmt::join(keys.begin(), keys.end(), ", ")));
}

std::string Section::full(std::string_view key) const {
    return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

SourceLocation Section::where(std::string_view key) const {
    const toml::node* node = table_.get(key);
    return node ? place(*node) : where_;
}

void Section::fail(SourceLocation where, const std::string& message) const {
    throw SceneError(file_, where, message);
}

void Section::fail(std::string_view key, const std::string& message) const {
    fail(where(key), message);
}

void Section::fail_choice(std::string_view key, const std::string& got,
                          const std::vector<const char*>& names) const {
    fail(key, fmt::format("unknown {} {}; use {}", full(key), in_quotes(got), listed(names)));
}

double Section::checked(const toml::node& node, const std::string& what, const Interval& allowed) const {
    if (!node.is_number())
        fail(place(node), fmt::format("{} must be a number, not {}", what, type_name(node)));
    const double x = *node.value<double>();
    if (x - x != 0.0) fail(place(node), fmt::format("{} must be a finite number", what));
    const bool high_enough = allowed.low_open ? x > allowed.low : x >= allowed.low;
    const bool low_enough = allowed.high_open ? x < allowed.high : x <= allowed.high;
    if (!high_enough || !low_enough) {
        fail(place(node), fmt::format("{} = {} is out of range; it must be {}", what, x, describe(allowed)));
    }
    return x;
}

std::optional<double> Section::number(std::string_view key, const Interval& allowed) const {
    const toml::node* node = table_.get(key);
    if (!node) return std::nullopt;
    return checked(*node, full(key), allowed);
}

double Section::number(std::string_view key, double fallback, const Interval& allowed) const {
    return number(key, allowed).value_or(fallback);
}

double Section::need_number(std::string_view key, const Interval& allowed) const {
    if (const auto x = number(key, allowed)) return *x;
    fail(where_, fmt::format("[{}] needs {} = a number", path_, key));
}

std::optional<std::int64_t> Section::integer(std::string_view key, std::int64_t low,
                                             std::int64_t high) const {
    const toml::node* node = table_.get(key);
    if (!node) return std::nullopt;
    if (!node->is_integer()) {
        const char* got = node->is_floating_point() ? "a number with a decimal point" : type_name(*node);
        fail(key, fmt::format("{} must be an integer, not {}", full(key), got));
    }
    const std::int64_t x = *node->value<std::int64_t>();
    if (x < low || x > high) {
        fail(key, fmt::format("{} = {} is out of range; it must be at least {} and at most {}", full(key), x,
                              low, high));
    }
    return x;
}

std::int64_t Section::integer(std::string_view key, std::int64_t fallback, std::int64_t low,
                              std::int64_t high) const {
    return integer(key, low, high).value_or(fallback);
}

std::optional<bool> Section::boolean(std::string_view key) const {
    const toml::node* node = table_.get(key);
    if (!node) return std::nullopt;
    if (!node->is_boolean())
        fail(key, fmt::format("{} must be true or false, not {}", full(key), type_name(*node)));
    return *node->value<bool>();
}

std::string Section::text(std::string_view key, const std::string& fallback) const {
    const toml::node* node = table_.get(key);
    if (!node) return fallback;
    if (!node->is_string())
        fail(key, fmt::format("{} must be a string in quotes, not {}", full(key), type_name(*node)));
    return *node->value<std::string>();
}

std::optional<std::vector<double>> Section::numbers(std::string_view key, std::size_t count,
                                                    const char* shape, const Interval& allowed) const {
    const toml::node* node = table_.get(key);
    if (!node) return std::nullopt;
    const toml::array* array = node->as_array();
    if (!array) fail(key, fmt::format("{} must be an array {}, not {}", full(key), shape, type_name(*node)));
    if (array->size() != count) {
        fail(key, fmt::format("{} has {} values; write {} = {}", full(key), array->size(), key, shape));
    }
    std::vector<double> out;
    for (const toml::node& element : *array) {
        out.push_back(checked(element, fmt::format("{}[{}]", full(key), out.size()), allowed));
    }
    return out;
}

Vec2 Section::vec2(std::string_view key, const Vec2& fallback, const char* shape,
                   const Interval& allowed) const {
    const auto values = numbers(key, 2, shape, allowed);
    return values ? Vec2((*values)[0], (*values)[1]) : fallback;
}

Vec2 Section::need_vec2(std::string_view key, const char* shape, const Interval& allowed) const {
    if (!has(key)) fail(where_, fmt::format("[{}] needs {} = {}", path_, key, shape));
    return vec2(key, Vec2::Zero(), shape, allowed);
}

const toml::table* Section::table(std::string_view key) const {
    const toml::node* node = table_.get(key);
    if (!node) return nullptr;
    if (!node->is_table()) {
        const char* hint = node->is_array_of_tables() ? " (single brackets, once)" : "";
        fail(key, fmt::format("{} must be a section [{}]{}, not {}", full(key), full(key), hint,
                              type_name(*node)));
    }
    return node->as_table();
}

std::optional<std::vector<const toml::table*>> Section::tables(std::string_view key) const {
    const toml::node* node = table_.get(key);
    if (!node) return std::nullopt;
    const std::string name = full(key);
    const toml::array* array = node->as_array();
    if (!array) {
        fail(key, fmt::format("{} is a list: write [[{}]] with double brackets, not {}", name, name,
                              type_name(*node)));
    }
    std::vector<const toml::table*> out;
    for (const toml::node& element : *array) {
        if (!element.is_table()) {
            fail(place(element),
                 fmt::format("{} must hold tables, not {}; write [[{}]]", name, type_name(element), name));
        }
        out.push_back(element.as_table());
    }
    return out;
}

}  // namespace carom::detail
