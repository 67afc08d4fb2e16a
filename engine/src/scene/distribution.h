// Distributions of a variation: reading and drawing.
#pragma once

#include <fmt/format.h>
#include <toml++/toml.h>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "carom/engine/variation.h"
#include "carom/kernel/splitmix64.h"

namespace carom::detail {

/// Refuses a rule; message and values as for fmt::format. @throws std::invalid_argument
template <class... Values>
[[noreturn]] void fail(fmt::format_string<Values...> message, Values&&... values) {
    throw std::invalid_argument(fmt::format(message, std::forward<Values>(values)...));
}

/// Every ListedValue is a ListItem, owned by the distribution.
struct ListItem : ListedValue {
    explicit ListItem(const toml::node& value);
    const toml::node* node;
    std::optional<double> exact;  ///< the number, if keys accept it
};

struct Distribution {
    std::function<DrawnValue(SplitMix64& random)> draw;
    ValueKind kind = ValueKind::kNumber;
    /// A grid has steps instead, and `at` returns the value of each; 0: not a grid.
    std::uint64_t steps = 0;
    std::function<DrawnValue(std::uint64_t step)> at{};
};

/// The text between the brackets of `name`(`text`), as TOML values. @throws std::invalid_argument
toml::array arguments(std::string_view name, std::string_view text);

/// @param text  "uniform(0,1)" and the like
/// @param own  the number in the file, or null; normal(sd) is centred on it
/// @throws std::invalid_argument with the fault
Distribution parse_distribution(std::string_view text, const toml::node* own);

}  // namespace carom::detail
