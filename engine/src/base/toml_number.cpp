#include "base/toml_number.h"

#include <fmt/format.h>

#include <stdexcept>

#include "base/units.h"

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

}  // namespace carom::detail
