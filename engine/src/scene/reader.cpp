#include "scene/reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/nearest.h"
#include "base/toml_number.h"

namespace carom::detail {
namespace {

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

UnknownKey::UnknownKey(const std::string& file, SourceLocation where, std::string_view key,
                       const std::string& section, const std::vector<std::string_view>& keys)
    : SceneError(file, where,
                 fmt::format("unknown {} {}{}; the {} are {}{}", section.empty() ? "section or key" : "key",
                             in_quotes(key), section.empty() ? "" : " in [" + section + "]",
                             section.empty() ? "sections" : "keys there", fmt::join(keys, ", "),
                             did_you_mean(key, keys))) {}

SourceLocation place(const toml::source_region& region) {
    return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

Section::Section(const toml::table& table, const std::string& file, std::string path,
                 const std::vector<std::string_view>& keys)
    : table_(&table), file_(file), path_(std::move(path)), where_(place(table.source())) {
    // toml++ sorts its keys; report the first unknown one in the file.
    const toml::key* unknown = nullptr;
    for (auto&& [key, value] : table) {
        if (std::find(keys.begin(), keys.end(), key.str()) != keys.end()) continue;
        if (!unknown || place(key.source()) < place(unknown->source())) unknown = &key;
    }
    if (!unknown) return;
    throw UnknownKey(file_, place(unknown->source()), unknown->str(), path_, keys);
}

std::string Section::full(std::string_view key) const {
    return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

SourceLocation Section::where(std::string_view key) const {
    const toml::node* node = table_ != nullptr ? table_->get(key) : nullptr;
    return node ? where(*node) : where_;
}

std::string Section::element(const Key& key, std::size_t k) const {
    return fmt::format("{}[{}]", full(key.key), k);
}

void Section::refuse(SourceLocation at, const std::string& what, const std::string& objection) const {
    if (!objection.empty()) fail(at, "{} {}", what, objection);
}

void Section::check_text(SourceLocation at, const std::string& x, const Key& key) const {
    const std::vector<const char*> names = key.names();
    if (!names.empty() && std::find(names.begin(), names.end(), x) == names.end())
        fail(at, "unknown {} {}; use {}{}", full(key.key), in_quotes(x), listed(names),
             did_you_mean(x, {names.begin(), names.end()}));
}

void Section::check_whole(SourceLocation at, const std::vector<double>& list, const Key& key) const {
    if (key.kind == Key::Kind::kIntegers &&
        std::any_of(list.begin(), list.end(), [](double x) { return x != std::floor(x); }))
        fail(at, "{} must be whole {}; drop the fraction", full(key.key), key.range.unit);
}

void Section::check(const Key& key, const FieldValue& value) const {
    if (const auto* number = std::get_if<double>(&value)) {
        refuse({}, full(key.key), objection(*number, key.range));
    } else if (const auto* whole = std::get_if<std::int64_t>(&value)) {
        refuse({}, full(key.key), objection(*whole, key.least(), key.most()));
    } else if (const auto* text = std::get_if<std::string>(&value)) {
        check_text({}, *text, key);
    } else if (const auto* list = std::get_if<std::vector<double>>(&value)) {
        for (std::size_t k = 0; k < list->size(); ++k)
            refuse({}, element(key, k), objection((*list)[k], key.range));
        check_whole({}, *list, key);
    }
}

double Section::number(const toml::node& node, const std::string& what, const Interval& allowed) const {
    try {
        return number_in(node, allowed);
    } catch (const std::invalid_argument& error) {
        fail(node, "{} {}", what, error.what());
    }
}

std::int64_t Section::integer(const toml::node& node, const Key& key) const {
    try {
        return integer_in(node, key.least(), key.most());
    } catch (const std::invalid_argument& error) {
        fail(node, "{} {}", full(key.key), error.what());
    }
}

std::string Section::text(const toml::node& node, const Key& key) const {
    // A switch, whose words are TOML's booleans.
    if (node.is_boolean() && key.options.names.size() == 2 &&
        key.options.names[0] == std::string_view("true"))
        return *node.value<bool>() ? "true" : "false";
    if (!node.is_string())
        fail(node, "{} must be a string in quotes, not {}", full(key.key), type_name(node));
    std::string got = *node.value<std::string>();
    check_text(where(node), got, key);
    return got;
}

std::vector<double> Section::numbers(const toml::node& node, const Key& key) const {
    const toml::array* array = node.as_array();
    const char* shape = key.options.shape;
    if (!array) fail(node, "{} must be an array {}, not {}", full(key.key), shape, type_name(node));
    const bool lacks = key.options.last_may_lack && array->size() + 1 == key.count();
    if (array->size() != key.count() && !lacks)
        fail(node, "{} has {} values; write {} = {}", full(key.key), array->size(), key.key, shape);
    std::vector<double> out;
    for (const toml::node& value : *array) out.push_back(number(value, element(key, out.size()), key.range));
    out.resize(key.count());
    return out;
}

FieldValue Section::value(const Key& key) const {
    const toml::node* node = table_->get(key.key);
    if (!node) {
        if (!key.options.needed) return {};
        fail(where_, "[{}] needs {} = {}", path_, key.key,
             key.kind == Key::Kind::kNumber ? "a number" : key.options.shape);
    }
    switch (key.kind) {
        case Key::Kind::kNumber:
            return number(*node, full(key.key), key.range);
        case Key::Kind::kInteger:
            return integer(*node, key);
        case Key::Kind::kText:
            return text(*node, key);
        case Key::Kind::kNumbers:
        case Key::Kind::kIntegers:
            break;
    }
    std::vector<double> list = numbers(*node, key);
    check_whole(where(*node), list, key);
    return list;
}

std::optional<bool> Section::boolean(std::string_view key) const {
    const toml::node* node = table_->get(key);
    if (!node) return std::nullopt;
    if (!node->is_boolean()) fail(key, "{} must be true or false, not {}", full(key), type_name(*node));
    return *node->value<bool>();
}

std::optional<Section> Section::section(const char* key, const std::vector<std::string_view>& keys) const {
    const toml::node* node = table_->get(key);
    if (!node) return std::nullopt;
    if (!node->is_table()) {
        const char* hint = !node->is_array_of_tables()        ? ""
                           : std::string_view(key) == "balls" ? " (single brackets, once; a ball is [[ball]])"
                                                              : " (single brackets, once)";
        fail(key, "{} must be a section [{}]{}, not {}", full(key), full(key), hint, type_name(*node));
    }
    return Section(*node->as_table(), file_, full(key), keys);
}

std::optional<std::vector<const toml::table*>> Section::tables(std::string_view key) const {
    const toml::node* node = table_->get(key);
    if (!node) return std::nullopt;
    const std::string name = full(key);
    const toml::array* array = node->as_array();
    if (!array)
        fail(key, "{} is a list: write [[{}]] with double brackets, not {}", name, name, type_name(*node));
    std::vector<const toml::table*> out;
    for (const toml::node& element : *array) {
        if (!element.is_table())
            fail(element, "{} must hold tables, not {}; write [[{}]]", name, type_name(element), name);
        out.push_back(element.as_table());
    }
    return out;
}

}  // namespace carom::detail
