#include "commands/sweep/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <future>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "base/console.h"
#include "report/table.h"

namespace carom::tools {
namespace {

/// The value of one column and shot. It is empty if a shot without a result does not have it.
void append_value(std::string& row, const SweepColumn& column, const ColumnValues& values, std::size_t shot,
                  bool has_result) {
    if (column.of_result && !has_result)
        row += ',';
    else if (column.kind == ValueKind::kNumber)
        append_csv(row, values.numbers[shot]);
    else if (column.kind == ValueKind::kWhole)
        append_csv(row, values.wholes[shot]);
    else
        append_csv(row, std::string_view(values.texts[static_cast<std::size_t>(values.places[shot])]));
}

games::MeasureValue value_of(const games::Measure& measure, const Record& record) {
    try {
        return measure.in_table(record);
    } catch (const std::invalid_argument& refused) {
        throw UsageError(fmt::format("--measure {}: {}", measure.text(), refused.what()));
    }
}

SweepRows play_part(const Sweep& sweep, std::uint64_t first, std::size_t shots) {
    const Variation& variation = sweep.variation;
    const std::size_t measures = sweep.measures.size();
    std::vector<games::MeasureValue> measured(shots * measures);
    BatchOptions options;
    options.threads = 1;
    options.stop = [] { return interrupted(); };
    if (measures > 0)
        options.judge = [&](std::size_t shot, const Outcome&, const Record& record) {
            for (std::size_t m = 0; m < measures; ++m)
                measured[shot * measures + m] = value_of(sweep.measures[m], record);
        };
    Batch batch(shots, variation.base().ball.size());
    std::vector<std::string> draws;
    try {
        batch.messages = simulate_many(variation, first, shots, sweep.isa, options, batch.arrays(), draws);
    } catch (const BatchStopped&) {
        throw Interrupted();
    }
    const std::vector<SweepColumn> columns = sweep_columns(variation);
    const std::vector<ColumnValues> values =
        sweep_values(variation, first, shots, draws, batch.arrays(), batch.messages);
    const std::size_t keys = variation.keys().size();
    SweepRows rows;
    for (std::size_t shot = 0; shot < shots; ++shot) {
        ++rows.outcomes[static_cast<std::size_t>(batch.status[shot])];
        for (std::size_t k = 0; k < columns.size(); ++k) {
            // A key's value is written as it was drawn.
            if (k >= 1 && k <= keys)
                append_csv(rows.text, std::string_view(draws[shot * keys + k - 1]));
            else
                append_value(rows.text, columns[k], values[k], shot, has_result(batch.status[shot]));
        }
        const bool result = has_result(batch.status[shot]);
        if (sweep.plot && result) {
            PlotShot& plotted = rows.plotted.emplace_back();
            plotted.value = std::get<double>(measured[shot * measures]);
            for (std::size_t axis = 0; axis < sweep.plot_keys.size(); ++axis) {
                const ColumnValues& of = values[sweep.plot_keys[axis] + 1];
                plotted.place[axis] =
                    of.numbers.empty() ? static_cast<double>(of.wholes[shot]) : of.numbers[shot];
            }
        }
        for (std::size_t m = 0; m < measures; ++m) {
            games::MeasureValue& value = measured[shot * measures + m];
            append_csv(rows.text, std::string_view(result ? games::text_of(value) : ""));
            if (result) rows.values.push_back(std::move(value));
        }
        rows.text.back() = '\n';
    }
    return rows;
}

/// The cells of a line of CSV; those in quotes may contain commas.
std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> cells;
    std::size_t begin = 0;
    bool quoted = false;
    for (std::size_t i = 0; i <= line.size(); ++i) {
        if (i < line.size() && line[i] == '"') quoted = !quoted;
        if (i < line.size() && (quoted || line[i] != ',')) continue;
        cells.push_back(line.substr(begin, i - begin));
        begin = i + 1;
    }
    return cells;
}

/// NaN for no number.
double number_in(std::string_view cell) {
    double number = 0.0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
    return error == std::errc() ? number : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<PlotShot> plotted_rows(const Sweep& sweep, std::string_view rows) {
    std::vector<PlotShot> shots;
    const std::size_t measure = sweep_columns(sweep.variation).size();
    for (; !rows.empty(); rows.remove_prefix(std::min(rows.size(), rows.find('\n') + 1))) {
        const std::vector<std::string_view> cells = cells_of(rows.substr(0, rows.find('\n')));
        if (cells.size() <= measure) continue;
        PlotShot& shot = shots.emplace_back();
        shot.value = number_in(cells[measure]);
        for (std::size_t axis = 0; axis < sweep.plot_keys.size(); ++axis)
            shot.place[axis] = number_in(cells[sweep.plot_keys[axis] + 1]);
    }
    return shots;
}

std::string sweep_header(const Sweep& sweep) {
    std::vector<Cell> cells;
    for (const SweepColumn& column : sweep_columns(sweep.variation)) cells.emplace_back(column.name);
    for (const games::Measure& measure : sweep.measures) cells.emplace_back(measure.text());
    return csv_line(cells);
}

SweepRows play_rows(const Sweep& sweep, std::uint64_t first, std::size_t shots) {
    const auto parts = static_cast<std::size_t>(sweep.threads);
    std::vector<std::future<SweepRows>> played;
    for (std::size_t i = 0; i < parts; ++i) {
        const std::size_t from = shots * i / parts, to = shots * (i + 1) / parts;
        if (to > from)
            played.push_back(
                std::async(std::launch::async, [&sweep, begin = first + from, count = to - from] {
                    return play_part(sweep, begin, count);
                }));
    }
    SweepRows rows;
    for (std::future<SweepRows>& part : played) {
        SweepRows more = part.get();
        rows.text += more.text;
        rows.values.insert(rows.values.end(), std::make_move_iterator(more.values.begin()),
                           std::make_move_iterator(more.values.end()));
        rows.plotted.insert(rows.plotted.end(), more.plotted.begin(), more.plotted.end());
        for (std::size_t i = 0; i < rows.outcomes.size(); ++i) rows.outcomes[i] += more.outcomes[i];
    }
    return rows;
}

}  // namespace carom::tools
