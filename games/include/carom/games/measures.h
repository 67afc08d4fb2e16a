// Measures of a shot by name, and expressions over them: the columns that a sweep adds, and the goal of a
// search.
//
//   pocketed the balls that fell, in this order
//   travel(cue) the length of a ball's path [m]
//   "9" in pocketed and not scratch
//   cue near (0.6, 1.2, 0.05) at rest within 5 cm of this place
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "carom/engine/record.h"
#include "carom/games/rules.h"

namespace carom::games {

/// A measure in the list that `carom describe measures` prints.
struct MeasureInfo {
    const char* name;
    const char* arguments;  ///< "", "BALL", "BALL, X, Y", "GAME"
    const char* unit;       ///< "m", "s", ...; "truth" for 0 or 1, "text", "list"
    const char* what;
};
std::span<const MeasureInfo> measures();

/// A number (NaN if undefined), or texts: a single text is a list of one.
using MeasureValue = std::variant<double, std::vector<std::string>>;
/// As in tables: "" for NaN, semicolons between texts.
std::string text_of(const MeasureValue& value);

/// A place where a ball should rest.
struct Place {
    int ball;
    Vec2 at;  ///< [m]
};

/// A mistake in an expression. what() states the place and what was expected.
class MeasureError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// An expression, read once and evaluated for many shots. In order of precedence: `or`, `and`, `not`, one of
/// == != < <= > >= in near, + and -, * and /. An empty text, an empty list, 0 and NaN are false.
class Measure {
  public:
    /// @param scene of the shots, with the balls and pockets that the expression names
    /// @param game the rules for `foul`, `break_foul` and `legal_break` without an argument
    /// @throws MeasureError
    Measure(const std::string& text, const Scene& scene, std::optional<Game> game = std::nullopt);
    ~Measure();
    Measure(Measure&&) noexcept;
    Measure& operator=(Measure&&) noexcept;

    const std::string& text() const { return text_; }
    bool is_number() const;  ///< whether its values are numbers
    bool is_truth() const;   ///< whether they are 0 or 1

    /// @throws std::invalid_argument for a shot that the game cannot judge (games::judge)
    MeasureValue of(const Record& record) const;
    bool holds(const Record& record) const;
    /// The centre of every `near` that must hold: the whole expression, or joined by `and`.
    std::vector<Place> places() const;
    /// As of(), for a row of a table: no value if the shot ended before its balls were at rest and the game
    /// cannot judge it.
    MeasureValue in_table(const Record& record) const;

    struct Node;

  private:
    std::string text_;
    std::unique_ptr<const Node> root_;
};

}  // namespace carom::games
