// The tree of an expression over measures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure_rows.h"

namespace carom::games {

/// A value, an operation, or a measure with its arguments.
struct Measure::Node {
    enum class Kind { kValue, kMeasure, kOr, kAnd, kNot, kCompare, kIn, kSum };
    Kind kind = Kind::kValue;
    std::string word{};  ///< the operator
    MeasureValue value{};
    const detail::MeasureRow* row = nullptr;
    detail::Arguments arguments{};
    std::vector<Node> parts{};
};

namespace detail {

bool is_number(const Measure::Node& node);

/// @throws MeasureError that states the place of the mistake
Measure::Node read_tree(const std::string& text, const Scene& scene, std::optional<Game> game);

}  // namespace detail
}  // namespace carom::games
