#include "base/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/as_number.h"
#include "carom/engine/printable.h"

namespace carom::detail {
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
