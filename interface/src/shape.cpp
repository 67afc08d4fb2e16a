#include "carom/interface/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "carom/engine/printable.h"

namespace carom::interface::shapes {
namespace {

std::string path_of(const Part& part) {
    const std::string whole = part.whole != nullptr ? path_of(*part.whole) : "";
    if (part.key != nullptr) return whole.empty() ? part.key : whole + "." + part.key;
    return part.whole != nullptr ? fmt::format("{}[{}]", whole, part.item) : "";
}

std::string keys_of(const Shape& shape) {
    std::vector<const char*> keys;
    for (const Shape::Member& row : shape.rows) keys.push_back(row.key);
    return fmt::format("{}", fmt::join(keys, ", "));
}

}  // namespace

void refuse(const Part& part, const std::string& fault) {
    const std::string path = path_of(part);
    throw ValueError(path.empty() ? fault : path + ": " + fault);
}

const char* plural_of(const Shape& shape) {
    switch (shape.kind) {
        case Shape::Kind::kTruth:
            return "truths";
        case Shape::Kind::kWhole:
            return "whole numbers";
        case Shape::Kind::kNumber:
            return "numbers";
        case Shape::Kind::kText:
            return "texts";
        case Shape::Kind::kChoice:
            return "names";
        default:
            return "objects";
    }
}

bool is_numbers(const Shape& shape) {
    if (shape.kind != Shape::Kind::kList && shape.kind != Shape::Kind::kArray) return false;
    return shape.item().kind == Shape::Kind::kNumber || is_numbers(shape.item());
}

Value write_rows(const Shape& shape, const void* from) {
    Value all = Value::object();
    for (const Shape::Member& row : shape.rows) {
        const Shape& of = row.shape();
        all[row.key] = row.get != nullptr
                           ? row.get(from)
                           : of.write(of, row.in(const_cast<void*>(from)));  // NOLINT: it is only read
    }
    return all;
}

void read_rows(const Shape& shape, const Value& value, const Part& part, const Shape::Limits&, void* to) {
    if (!value.is_object()) refuse(part, "expected an object with " + keys_of(shape));
    std::size_t known = 0;
    for (const Shape::Member& row : shape.rows) {
        const auto found = value.find(row.key);
        const Part inner{&part, row.key};
        if (found == value.end()) {
            // No kind of value accepts null, so its reader reports the expected one.
            if (row.is_needed) row.shape().read(row.shape(), Value(), inner, {}, row.in(to));
            continue;
        }
        ++known;
        if (row.in != nullptr) row.shape().read(row.shape(), *found, inner, row.limits, row.in(to));
        if (row.set != nullptr) row.set(to, *found, inner);
    }
    if (known < value.size()) {
        for (const auto& item : value.items()) {
            const auto is_its_row = [&](const Shape::Member& row) { return item.key() == row.key; };
            if (std::none_of(shape.rows.begin(), shape.rows.end(), is_its_row))
                refuse(part, fmt::format("unknown key {}; expected one of {}", in_quotes(item.key()),
                                         keys_of(shape)));
        }
    }
    if (shape.complete == nullptr) return;
    try {
        shape.complete(to);
    } catch (const std::invalid_argument& refused) {
        const std::string path = path_of(part);
        throw ValueError(path.empty() ? refused.what() : path + "." + refused.what());
    }
}

std::size_t choice_of(const Shape& shape, const Value& value, const Part& part) {
    if (value.is_string())
        for (std::size_t i = 0; i < shape.names.size(); ++i)
            if (value.get_ref<const std::string&>() == shape.names[i]) return i;
    refuse(part, fmt::format("expected one of {}", fmt::join(shape.names, ", ")));
}

std::int64_t whole_of(const Value& value, const Part& part, Whole range, std::int64_t least,
                      std::int64_t most) {
    const bool any = range.least == range.most;
    if (!any) {
        least = range.least;
        most = range.most;
    }
    if (!value.is_number_integer() ||
        (value.is_number_unsigned() && value.get<std::uint64_t>() > INT64_MAX) ||
        value.get<std::int64_t>() < least || value.get<std::int64_t>() > most)
        refuse(part, fmt::format("expected a whole number from {} to {}", least, most));
    return value.get<std::int64_t>();
}

bool truth_of(const Value& value, const Part& part) {
    if (!value.is_boolean()) refuse(part, "expected true or false");
    return value.get<bool>();
}

double number_of(const Value& value, const Part& part, bool may_be_nan) {
    if (may_be_nan && value.is_null()) return std::numeric_limits<double>::quiet_NaN();
    if (!value.is_number() || (!may_be_nan && !std::isfinite(value.get<double>())))
        refuse(part, may_be_nan ? "expected a number or null" : "expected a number");
    return value.get<double>();
}

std::string text_of(const Value& value, const Part& part) {
    if (!value.is_string()) refuse(part, "expected a text");
    return value.get<std::string>();
}

std::string meaning_of(const Key& key) {
    return *key.range.unit == '\0' ? key.meaning : fmt::format("{} [{}]", key.meaning, key.range.unit);
}

Value value_of_field(const FieldValue& field) {
    return std::visit(
        [](const auto& value) -> Value {
            if constexpr (std::is_same_v<decltype(value), const std::monostate&>)
                return {};
            else
                return value;
        },
        field);
}

FieldValue field_of(const Key& key, const Value& value, const Part& part) {
    if (key.kind == Key::Kind::kNumber) return number_of(value, part);
    if (key.kind == Key::Kind::kText) {
        const std::vector<const char*> names = key.names();
        const std::string text = text_of(value, part);
        if (!names.empty() && std::find(names.begin(), names.end(), text) == names.end())
            refuse(part, fmt::format("expected one of {}", fmt::join(names, ", ")));
        return text;
    }
    std::vector<double> list;
    const Shape& numbers = shape_of<std::vector<double>>();
    numbers.read(numbers, value, part, {}, &list);
    if (list.size() != key.count()) refuse(part, fmt::format("expected a list of {} numbers", key.count()));
    return list;
}

const Shape& (*shape_of_field(const Key& key))() {
    if (key.kind == Key::Kind::kNumber) return shape_of<double>;
    if (key.kind == Key::Kind::kText) return shape_of<std::string>;
    return key.count() == 2 ? shape_of<std::array<double, 2>> : shape_of<std::array<double, 3>>;
}

}  // namespace carom::interface::shapes
