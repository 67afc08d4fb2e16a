#include "carom/games/sweep.h"

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace carom::games {
namespace {

using Of = SweepColumn::Of;

/// The balls that fell, in order, separated by semicolons.
std::string fallen(const std::vector<BallStart>& balls, const std::int32_t* fell) {
    std::vector<const std::string*> order(balls.size());
    for (std::size_t i = 0; i < balls.size(); ++i)
        if (fell[i] >= 0) order[static_cast<std::size_t>(fell[i])] = &balls[i].id;
    std::string text;
    for (std::size_t k = 0; k < order.size() && order[k] != nullptr; ++k) {
        if (k > 0) text += ';';
        text += *order[k];
    }
    return text;
}

std::vector<SweepColumn> columns_of(const Variation& variation, const std::vector<Measure>& measures) {
    using enum ValueKind;
    std::vector<SweepColumn> columns = {{"shot", kWhole, "", false, Of::kShot}};
    for (std::size_t k = 0; k < variation.keys().size(); ++k)
        columns.push_back({variation.keys()[k], variation.kind(k), variation.unit(k), false, Of::kKey, k});
    const auto add = [&columns](const OutcomeColumn& outcome, const std::string& name, std::size_t which) {
        const ValueKind kind = kind_of(outcome);
        columns.push_back(
            {name, kind, kind == kText ? "" : outcome.unit, name != "status", Of::kOutcome, which, &outcome});
    };
    for (const OutcomeColumn& outcome : kOutcomeColumns)
        if (outcome.per_ball == 0 && !outcome.on_request) add(outcome, outcome.name, 0);
    columns.push_back({"pocketed", kText, "", true, Of::kPocketed});
    for (std::size_t i = 0; i < variation.base().ball.size(); ++i)
        for (const OutcomeColumn& outcome : kOutcomeColumns)
            for (std::size_t k = 0; k < outcome.per_ball; ++k) {
                const std::string_view name = outcome.name;
                add(outcome,
                    fmt::format("{}.{}", variation.base().ball[i].id,
                                outcome.per_ball > 1 ? name.substr(k, 1) : name),
                    i * outcome.per_ball + k);
            }
    columns.push_back({"message", kText, "", false, Of::kMessage});
    for (std::size_t m = 0; m < measures.size(); ++m) {
        const std::string& text = measures[m].text();
        // A table has each name once.
        std::erase_if(columns, [&text](const SweepColumn& column) { return column.name == text; });
        columns.push_back({text, measures[m].is_number() ? kNumber : kText, "", true, Of::kMeasure, m});
    }
    return columns;
}

}  // namespace

Sweep::Sweep(Variation variation, std::span<const std::string> measures, std::optional<Game> game)
    : variation_(std::move(variation)) {
    for (const std::string& text : measures) measures_.emplace_back(text, variation_.base(), game);
    columns_ = columns_of(variation_, measures_);
}

SweptShots Sweep::play(std::uint64_t first, std::size_t count, kernel::Isa isa, BatchOptions options,
                       const BatchArrays& out,
                       const std::function<void(const SweptShots&, std::size_t)>& done) const {
    const std::size_t measures = measures_.size();
    SweptShots shots{
        first, count, out, {}, std::vector<MeasureValue>(count * measures), std::vector<std::string>(count)};
    if (measures > 0)
        options.judge = [&](std::size_t shot, const Outcome&, const Record& record) {
            for (std::size_t m = 0; m < measures; ++m) {
                try {
                    shots.measured[shot * measures + m] = measures_[m].in_table(record);
                } catch (const std::invalid_argument& refused) {
                    throw MeasureError(measures_[m].text() + ": " + refused.what());
                }
            }
        };
    options.done = [&](std::size_t shot, const std::string& message) {
        shots.messages[shot] = message;
        if (done) done(shots, shot);
    };
    simulate_many(variation_, first, count, isa, options, out, shots.draws);
    return shots;
}

SweepValue Sweep::value(const SweepColumn& column, const SweptShots& shots, std::size_t shot) const {
    const BatchArrays& out = shots.outcomes;
    if (column.of_result && !has_result(out.status[shot])) return {};
    const std::vector<BallStart>& balls = variation_.base().ball;
    switch (column.of) {
        case Of::kShot:
            return static_cast<std::int64_t>(shots.first + shot);
        case Of::kKey: {
            const DrawnValue& drawn = shots.draws[shot * variation_.keys().size() + column.which];
            if (column.kind == ValueKind::kNumber) return number_of(drawn);
            if (column.kind == ValueKind::kWhole) return integer_of(drawn);
            return text_of(drawn);
        }
        case Of::kOutcome:
            break;
        case Of::kPocketed:
            return fallen(balls, out.fell + shot * balls.size());
        case Of::kMessage:
            return shots.messages[shot];
        case Of::kMeasure: {
            const MeasureValue& measured = shots.measured[shot * measures_.size() + column.which];
            if (column.kind == ValueKind::kText) return text_of(measured);
            return std::get<double>(measured);
        }
    }
    const std::size_t at = shot * column.outcome->each(balls.size()) + column.which;
    return std::visit([](auto&& value) -> SweepValue { return value; },
                      value_of(*column.outcome, out, at, variation_.base()));
}

}  // namespace carom::games
