#include "commands/sweep/row.h"

#include <cstddef>
#include <cstdint>

#include "base/setup.h"
#include "carom/engine/sweep_columns.h"
#include "report/table.h"

namespace carom::tools {

std::string sweep_header(const Variation& variation) {
    std::vector<Cell> cells;
    for (const SweepColumn& column : sweep_columns(variation)) cells.emplace_back(column.name);
    return csv_line(cells);
}

SweepPlayer::SweepPlayer(const Variation& variation, kernel::Isa isa)
    : variation_(variation), simulator_(variation.base(), isa), options_(interruptible()) {}

void SweepPlayer::append_results(std::string& rows) {
    const std::vector<BallStart>& balls = variation_.base().ball;
    const Outcome& outcome = simulator_.outcome();
    append_csv(rows, outcome.duration);
    append_csv(rows, outcome.events);
    append_csv(rows, outcome.first_hit < 0 ? std::string_view() : balls[outcome.first_hit].id);
    append_csv(rows, static_cast<std::int64_t>(outcome.contacts));
    append_csv(rows, static_cast<std::int64_t>(outcome.approach_cushions));
    fallen_.assign(balls.size(), -1);
    for (std::size_t i = 0; i < balls.size(); ++i)
        if (outcome.balls[i].fell >= 0) fallen_[outcome.balls[i].fell] = static_cast<int>(i);
    for (std::size_t k = 0; k < fallen_.size() && fallen_[k] >= 0; ++k) {
        if (k > 0) rows += ';';
        append_csv(rows, balls[fallen_[k]].id);
        rows.pop_back();
    }
    rows += ',';
    for (const BallOutcome& ball : outcome.balls) {
        append_csv(rows, ball.position.x());
        append_csv(rows, ball.position.y());
        append_csv(rows, ball.pocket == kOffTable ? std::string_view("out")
                         : ball.pocket < 0        ? std::string_view()
                                                  : simulator_.scene().table.pockets[ball.pocket].id);
    }
}

ShotStatus SweepPlayer::append(std::uint64_t index, std::string& rows) {
    const ShotStatus status = simulator_.play(variation_, index, values_, options_);
    append_csv(rows, static_cast<std::int64_t>(index));
    for (const std::string& value : values_) append_csv(rows, value);
    append_csv(rows, name(status));
    if (has_result(status))
        append_results(rows);
    else
        rows.append(6 + 3 * variation_.base().ball.size(), ',');
    append_csv(rows, simulator_.message());
    rows.back() = '\n';
    return status;
}

}  // namespace carom::tools
