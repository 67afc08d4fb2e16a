// Distributions of a variation: reading and drawing.
#pragma once

#include <fmt/format.h>
#include <toml++/toml.h>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <variant>

#include "base/splitmix64.h"
#include "carom/engine/variation.h"

namespace carom::detail {

/// Refuses a rule; the message and its values are as for fmt::format. @throws std::invalid_argument
template <class... Values>
[[noreturn]] void fail(fmt::format_string<Values...> message, Values&&... values) {
    throw std::invalid_argument(fmt::format(message, std::forward<Values>(values)...));
}

/// A drawn value; a node belongs to the distribution.
using Drawn = std::variant<double, std::int64_t, const toml::node*>;

/// Draws a value.
using Distribution = std::function<Drawn(SplitMix64& random)>;

/// What stands between the brackets of `name`(`text`), as TOML values. @throws std::invalid_argument
toml::array arguments(std::string_view name, std::string_view text);

/// @param text  "uniform(0,1)" and the like
/// @param own  the number that the file has, null where there is none; normal(sd) is around it
/// @throws std::invalid_argument saying what is wrong
Distribution parse_distribution(std::string_view text, const toml::node* own);
/// What a distribution that can be read draws: a list has whole numbers only where all of it are.
ValueKind kind_of(std::string_view text);

}  // namespace carom::detail
