// The one door by which a number of a TOML file or flag becomes a number of the program: `value<double>()` of
// toml++ is empty for an integer that no double holds, and what is empty must not be read.
#pragma once

#include <toml++/toml.h>
#include <cstdint>
#include <string>

#include "carom/engine/field.h"

namespace carom::detail {

/// What a value is, for messages: "an integer", "a table".
const char* type_name(const toml::node& node);

/// What is wrong with a number, as it goes on after the name of the value; "" if nothing is.
std::string objection(double x, const Interval& allowed);
std::string objection(std::int64_t x, std::int64_t low, std::int64_t high);

/// A range for what is any finite number.
inline constexpr Interval kAnyNumber = {-0x1.fffffffffffffp1023, false, 0x1.fffffffffffffp1023, false, ""};

/// @throws std::invalid_argument what is wrong with the node, as it goes on after the name of the value
double number_in(const toml::node& node, const Interval& allowed = kAnyNumber);
std::int64_t integer_in(const toml::node& node, std::int64_t low = INT64_MIN, std::int64_t high = INT64_MAX);

}  // namespace carom::detail
