// The table of a sweep: one list of columns, for the program's rows and for code that stores arrays.
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
    std::string unit;        ///< "" if it has none
    bool of_result = false;  ///< empty for shots without a result
};

/// shot, KEY..., outcome, duration, events, first_contact,
/// contacts, cushions, pocketed, ID.x, ID.y, ID.pocket..., message
std::vector<SweepColumn> sweep_columns(const Variation& variation);

/// The values of one column for some shots; only the arrays of its kind are filled.
struct ColumnValues {
    std::vector<double> numbers;       ///< NaN for no value
    std::vector<std::int64_t> wholes;  ///< 0 for no value
    std::vector<std::int32_t> places;  ///< index of each shot's text in `texts`, -1 for no value
    std::vector<std::string> texts;    ///< each text once, in order of first appearance
};

/// The values of sweep_columns() for shots first, first + 1, ... of simulate_many.
/// @param draws     the values that simulate_many returned
/// @param outcomes  needs all arrays except `cushions` and `hash`
std::vector<ColumnValues> sweep_values(const Variation& variation, std::uint64_t first, std::size_t shots,
                                       std::span<const std::string> draws, const BatchArrays& outcomes,
                                       std::span<const Batch::Message> messages);

}  // namespace carom
