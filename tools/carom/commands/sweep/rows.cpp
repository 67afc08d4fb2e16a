#include "commands/sweep/rows.h"

#include <fmt/format.h>

#include <string_view>
#include <variant>
#include <vector>

#include "base/console.h"
#include "report/table.h"

namespace carom::tools {
namespace {

struct AppendCsv {
    std::string& row;
    void operator()(std::monostate) const { row += ','; }
    void operator()(double number) const { append_csv(row, number); }
    void operator()(std::int64_t whole) const { append_csv(row, whole); }
    void operator()(const std::string& text) const { append_csv(row, std::string_view(text)); }
    void operator()(const ListedValue* listed) const { (*this)(listed->text); }
};

std::string row_of(const games::Sweep& sweep, const games::SweptShots& shots, std::size_t shot) {
    using Of = games::SweepColumn::Of;
    std::string row;
    row.reserve(256);
    const AppendCsv append{row};
    const std::size_t keys = sweep.variation().keys().size(), measures = sweep.measures().size();
    for (const games::SweepColumn& column : sweep.columns()) {
        // A number of a list is written as in the list, and a measure without a value is empty, not nan.
        if (column.of == Of::kKey)
            std::visit(append, shots.draws[shot * keys + column.which]);
        else if (column.of == Of::kMeasure && has_result(shots.outcomes.status[shot]))
            append(games::text_of(shots.measured[shot * measures + column.which]));
        else
            std::visit(append, sweep.value(column, shots, shot));
    }
    row.back() = '\n';
    return row;
}

}  // namespace

SweepBlock play_block(const games::Sweep& sweep, std::uint64_t first, std::size_t count, kernel::Isa isa,
                      int threads, std::mutex& playing) {
    BatchOptions options;
    options.threads = threads;
    options.stop = [] { return interrupted(); };
    SweepBlock block{Batch(count, sweep.variation().base().ball.size()), {}, std::vector<std::string>(count)};
    const std::lock_guard turn(playing);
    try {
        block.shots = sweep.play(first, count, isa, options, block.batch,
                                 [&](const games::SweptShots& shots, std::size_t shot) {
                                     block.rows[shot] = row_of(sweep, shots, shot);
                                 });
    } catch (const BatchStopped&) {
        throw Interrupted();
    } catch (const games::MeasureError& refused) {
        throw UsageError(fmt::format("--measure {}", refused.what()));
    }
    return block;
}

std::string sweep_header(const games::Sweep& sweep) {
    std::vector<Cell> cells;
    for (const games::SweepColumn& column : sweep.columns()) cells.emplace_back(column.name);
    return csv_line(cells);
}

}  // namespace carom::tools
