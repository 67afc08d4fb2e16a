#include "base/toml_number.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/as_number.h"
#include "carom/engine/printable.h"

namespace carom::detail {
namespace {

std::string describe(const Interval& i) {
    return fmt::format("{} {} and {} {}{}{}", i.low_open ? "more than" : "at least", i.low,
                       i.high_open ? "less than" : "at most", i.high, *i.unit ? " " : "", i.unit);
}

/// @param written  the number with all its digits
template <class Number>
std::string objection(double x, Number written, const Interval& allowed) {
    if (x - x != 0.0) return "must be a finite number";
    if (is_tiny(x) && contains(allowed, x > 0.0 ? kLeastSize : -kLeastSize))
        return fmt::format("= {} is too small to compute with; write 0, or at least {}", written, kLeastSize);
    if (!contains(allowed, x))
        return fmt::format("= {} is out of range; it must be {}", written, describe(allowed));
    return "";
}

void refuse(const std::string& what) {
    if (!what.empty()) throw std::invalid_argument(what);
}

}  // namespace

const char* type_name(const toml::node& node) {
    // In the order of toml::node_type.
    static constexpr const char* kNames[] = {"nothing",    "a table",  "an array", "a string",
                                             "an integer", "a number", "a boolean"};
    static_assert(static_cast<int>(toml::node_type::boolean) == 6);
    return node.type() <= toml::node_type::boolean ? kNames[static_cast<int>(node.type())] : "a date or time";
}

std::string objection(double x, const Interval& allowed) {
    return objection(x, x, allowed);
}

std::string objection(std::int64_t x, std::int64_t low, std::int64_t high) {
    if (x >= low && x <= high) return "";
    return fmt::format("= {} is out of range; it must be at least {} and at most {}", x, low, high);
}

double number_in(const toml::node& node, const Interval& allowed) {
    if (const auto* written = node.as_floating_point()) {
        refuse(objection(written->get(), allowed));
        return written->get();
    }
    if (const auto* text = node.as_string()) {
        const double x = number_with_unit(text->get(), allowed.unit);
        refuse(objection(x, allowed));
        return x;
    }
    const auto* written = node.as_integer();
    if (written == nullptr) refuse(fmt::format("must be a number, not {}", type_name(node)));
    const std::int64_t whole = written->get();
    const double x = static_cast<double>(whole);
    refuse(objection(x, whole, allowed));
    // Do not convert back: 2^63 is not a valid integer.
    if (!node.value<double>())
        refuse(fmt::format("= {} has more digits than a number can store; write {:.1f}, the nearest one",
                           whole, x));
    return x;
}

std::int64_t integer_in(const toml::node& node, std::int64_t low, std::int64_t high) {
    const auto* written = node.as_integer();
    if (written == nullptr)
        refuse(fmt::format("must be an integer, not {}",
                           node.is_floating_point() ? "a number with a decimal point" : type_name(node)));
    refuse(objection(written->get(), low, high));
    return written->get();
}

namespace {

/// A unit of the quantity measured in `of`: `factor` or, exactly, ten to the power of `ten`.
struct Unit {
    std::string_view name, of;
    int ten;
    double factor;
};
// NIST Special Publication 811, appendix B: the inch, the foot, the mile and the pound are exact.
constexpr Unit kUnits[] = {
    {"m", "m", 0, 0.0},
    {"cm", "m", -2, 0.0},
    {"mm", "m", -3, 0.0},
    {"in", "m", 0, 0.0254},
    {"ft", "m", 0, 0.3048},
    {"m/s", "m/s", 0, 0.0},
    {"km/h", "m/s", 0, 1.0 / 3.6},
    {"mph", "m/s", 0, 0.44704},
    {"ft/s", "m/s", 0, 0.3048},
    {"kg", "kg", 0, 0.0},
    {"g", "kg", -3, 0.0},
    {"oz", "kg", 0, 0.028349523125},
    {"lb", "kg", 0, 0.45359237},
    {"s", "s", 0, 0.0},
    {"ms", "s", -3, 0.0},
    {"degrees", "degrees", 0, 0.0},
    {"deg", "degrees", 0, 0.0},
    {"rad", "degrees", 0, 57.29577951308232},
};
// [bytes] A longer number is a mistake.
constexpr std::size_t kLongest = 64;

[[noreturn]] void refuse(std::string_view text, std::string_view wanted) {
    std::string names;
    for (const Unit& unit : kUnits)
        if (unit.of == wanted) names += fmt::format("{}{}", names.empty() ? "" : ", ", unit.name);
    if (names.empty()) throw std::invalid_argument("must be a number, not a string");
    throw std::invalid_argument(fmt::format(
        "must be a number, or a number with a unit in quotes ({}), not {}", names, in_quotes(text)));
}

}  // namespace

double number_with_unit(std::string_view text, std::string_view wanted) {
    const std::size_t end = text.find_last_of("0123456789.") + 1;
    std::string_view digits = text.substr(0, end), name = text.substr(end);
    name.remove_prefix(std::min(name.find_first_not_of(' '), name.size()));
    if (digits.starts_with('+')) digits.remove_prefix(1);
    const bool plain = !digits.empty() && digits.size() <= kLongest &&
                       digits.find_first_not_of("0123456789.+-eE") == digits.npos;
    for (const Unit& unit : kUnits) {
        if (!plain || unit.of != wanted || unit.name != name) continue;
        std::string written(digits);
        if (unit.ten != 0) {
            if (digits.find_first_of("eE") != digits.npos) break;
            written += fmt::format("e{}", unit.ten);
        }
        const auto value = as_number<double>(written);
        if (!value) break;
        return unit.factor != 0.0 ? *value * unit.factor : *value;
    }
    refuse(text, wanted);
}

}  // namespace carom::detail
