// The only way to read numbers from a TOML file or flag: `value<double>()` of toml++ is empty for an integer
// that no double can represent, and an empty value must not be read.
#pragma once

#include <toml++/toml.h>
#include <cstdint>
#include <string>
#include <string_view>

#include "carom/engine/field.h"

namespace carom::detail {

/// The type of a value, for messages: "an integer", "a table".
const char* type_name(const toml::node& node);

/// The fault of a number, to follow the value's name in a message; "" if there is none.
std::string objection(double x, const Interval& allowed);
std::string objection(std::int64_t x, std::int64_t low, std::int64_t high);

inline constexpr Interval kAnyNumber = {-0x1.fffffffffffffp1023, false, 0x1.fffffffffffffp1023, false, ""};

/// @throws std::invalid_argument with the fault, to follow the value's name
double number_in(const toml::node& node, const Interval& allowed = kAnyNumber);
std::int64_t integer_in(const toml::node& node, std::int64_t low = INT64_MIN, std::int64_t high = INT64_MAX);

/// The number in the unit `wanted` of a key ("m", "m/s", "kg", "s", "degrees"). Units that differ by a power
/// of ten give the same bits as the number written out: "57.15 mm" is 0.05715.
/// @throws std::invalid_argument with the fault and the available units, to follow the key's name
double number_with_unit(std::string_view text, std::string_view wanted);

}  // namespace carom::detail
