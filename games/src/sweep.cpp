#include "carom/games/sweep.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
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
    columns.push_back({"outcome", kText, "", false, Of::kOutcome});
    columns.push_back({"duration", kNumber, "s", true, Of::kDuration});
    columns.push_back({"events", kWhole, "", true, Of::kEvents});
    columns.push_back({"first_contact", kText, "", true, Of::kFirstContact});
    columns.push_back({"contacts", kWhole, "", true, Of::kContacts});
    columns.push_back({"cushions", kWhole, "", true, Of::kCushions});
    columns.push_back({"pocketed", kText, "", true, Of::kPocketed});
    for (std::size_t i = 0; i < variation.base().ball.size(); ++i) {
        const std::string& id = variation.base().ball[i].id;
        columns.push_back({id + ".x", kNumber, "m", true, Of::kX, i});
        columns.push_back({id + ".y", kNumber, "m", true, Of::kY, i});
        columns.push_back({id + ".pocket", kText, "", true, Of::kPocket, i});
    }
    columns.push_back({"message", kText, "", false, Of::kMessage});
    for (std::size_t m = 0; m < measures.size(); ++m)
        columns.push_back(
            {measures[m].text(), measures[m].is_number() ? kNumber : kText, "", true, Of::kMeasure, m});
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
    const std::size_t ball = shot * balls.size() + column.which;  // in the columns of balls
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
            return std::string(name(out.status[shot]));
        case Of::kDuration:
            return out.duration[shot];
        case Of::kEvents:
            return out.events[shot];
        case Of::kFirstContact: {
            const std::int32_t hit = out.first_hit[shot];
            return hit < 0 ? std::string() : balls[static_cast<std::size_t>(hit)].id;
        }
        case Of::kContacts:
            return std::int64_t{out.contacts[shot]};
        case Of::kCushions:
            return std::int64_t{out.approach_cushions[shot]};
        case Of::kPocketed:
            return fallen(balls, out.fell + shot * balls.size());
        case Of::kX:
            return out.x[ball * out.place_stride];
        case Of::kY:
            return out.y[ball * out.place_stride];
        case Of::kPocket: {
            const std::int32_t pocket = out.pocket[ball];
            if (pocket == kOffTable) return std::string("out");
            return pocket < 0 ? std::string()
                              : variation_.base().table.pockets[static_cast<std::size_t>(pocket)].id;
        }
        case Of::kMessage:
            return shots.messages[shot];
        case Of::kMeasure:
            break;
    }
    const MeasureValue& measured = shots.measured[shot * measures_.size() + column.which];
    if (column.kind == ValueKind::kText) return text_of(measured);
    return std::get<double>(measured);
}

}  // namespace carom::games
