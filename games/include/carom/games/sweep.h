// A sweep: the shots of a variation as rows of a table, with measures. `carom sweep` writes these rows, and
// Python stores their columns as arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "carom/engine/batch.h"
#include "carom/engine/variation.h"
#include "carom/games/measures.h"

namespace carom::games {

struct SweepColumn {
    enum class Of : std::uint8_t { kShot, kKey, kOutcome, kPocketed, kMessage, kMeasure };

    std::string name;
    ValueKind kind;
    std::string unit;       ///< "" if it has none
    bool of_result;         ///< empty for shots without a result
    Of of;                  ///< the contents of the column
    std::size_t which = 0;  ///< the key, the measure, or the number among those of a shot
    const OutcomeColumn* outcome = nullptr;
};

/// A value of a row, of the column's kind; empty if the shot has none.
using SweepValue = std::variant<std::monostate, double, std::int64_t, std::string>;

/// Shots that were played.
struct SweptShots {
    std::uint64_t first = 0;  ///< the number of the first shot
    std::size_t count = 0;
    BatchArrays outcomes;                ///< of the caller
    std::vector<DrawnValue> draws;       ///< count x keys
    std::vector<MeasureValue> measured;  ///< count x measures
    std::vector<std::string> messages;   ///< why a shot has no result, or ""
};

class Sweep {
  public:
    /// @throws MeasureError
    Sweep(Variation variation, std::span<const std::string> measures, std::optional<Game> game);
    Sweep(Sweep&&) = default;  // measures cannot be copied

    const Variation& variation() const { return variation_; }
    const std::vector<Measure>& measures() const { return measures_; }
    /// shot, KEY..., the outcomes of a shot, pocketed, the outcomes of each ball (ID.x, ID.y, ID.pocket,
    /// ...), message, MEASURE...
    const std::vector<SweepColumn>& columns() const { return columns_; }

    /// Plays shots first, first + 1, ... A row depends only on the variation and the number of its shot.
    /// @param options  `judge` and `done` are not called
    /// @param out  needs all arrays except those on request
    /// @param done  called by each thread after every shot, whose row is complete
    /// @throws MeasureError for a measure that does not apply to such shots, and as simulate_many
    SweptShots play(std::uint64_t first, std::size_t count, kernel::Isa isa, BatchOptions options,
                    const BatchArrays& out,
                    const std::function<void(const SweptShots& shots, std::size_t shot)>& done = {}) const;
    SweepValue value(const SweepColumn& column, const SweptShots& shots, std::size_t shot) const;

  private:
    Variation variation_;
    std::vector<Measure> measures_;
    std::vector<SweepColumn> columns_;
};

}  // namespace carom::games
