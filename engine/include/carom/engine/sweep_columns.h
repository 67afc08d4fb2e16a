// The table that a sweep makes of its shots: one list of columns,
// for the program's rows and for whatever keeps arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "carom/engine/batch.h"
#include "carom/engine/variation.h"

namespace carom {

struct SweepColumn {
    std::string name;
    ValueKind kind = ValueKind::kNumber;
    std::string unit;        ///< "" where it has none
    bool of_result = false;  ///< shots without a result have no value
};

/// shot, KEY..., outcome, duration, events, first_contact,
/// contacts, cushions, pocketed, ID.x, ID.y, ID.pocket..., message
std::vector<SweepColumn> sweep_columns(const Variation& variation);

/// What one column has of some shots; only the arrays of its kind are filled.
struct ColumnValues {
    std::vector<double> numbers;       ///< NaN for no value
    std::vector<std::int64_t> wholes;  ///< 0 for no value
    std::vector<std::int32_t> places;  ///< of a shot's text in `texts`, -1 for no value
    std::vector<std::string> texts;    ///< each once, in the order in which they come first
};

/// The values of sweep_columns() of shots first, first + 1, ... that simulate_many has played.
/// @param draws     what simulate_many gave as their values
/// @param outcomes  all arrays but `cushions` and `hash` are needed
std::vector<ColumnValues> sweep_values(const Variation& variation, std::uint64_t first, std::size_t shots,
                                       std::span<const std::string> draws, const BatchArrays& outcomes,
                                       std::span<const Batch::Message> messages);

}  // namespace carom
