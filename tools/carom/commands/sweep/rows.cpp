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
    std::string& rows;
    void operator()(std::monostate) const { rows += ','; }
    void operator()(double number) const { append_csv(rows, number); }
    void operator()(std::int64_t whole) const { append_csv(rows, whole); }
    void operator()(const std::string& text) const { append_csv(rows, std::string_view(text)); }
    void operator()(const ListedValue* listed) const { (*this)(listed->text); }
};

}  // namespace

SweepBlock play_block(const games::Sweep& sweep, std::uint64_t first, std::size_t count, kernel::Isa isa,
                      int threads) {
    BatchOptions options;
    options.threads = threads;
    options.stop = [] { return interrupted(); };
    SweepBlock block{Batch(count, sweep.variation().base().ball.size()), {}};
    try {
        block.shots = sweep.play(first, count, isa, options, block.batch.arrays());
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

std::string sweep_rows(const games::Sweep& sweep, const games::SweptShots& shots) {
    using Of = games::SweepColumn::Of;
    std::string rows;
    const AppendCsv append{rows};
    const std::size_t keys = sweep.variation().keys().size(), measures = sweep.measures().size();
    for (std::size_t shot = 0; shot < shots.count; ++shot) {
        for (const games::SweepColumn& column : sweep.columns()) {
            // A number of a list is written as in the list, and a measure without a value is empty, not nan.
            if (column.of == Of::kKey)
                std::visit(append, shots.draws[shot * keys + column.which]);
            else if (column.of == Of::kMeasure && has_result(shots.outcomes.status[shot]))
                append(games::text_of(shots.measured[shot * measures + column.which]));
            else
                std::visit(append, sweep.value(column, shots, shot));
        }
        rows.back() = '\n';
    }
    return rows;
}

}  // namespace carom::tools
