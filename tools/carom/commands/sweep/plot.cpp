#include "commands/sweep/plot.h"

#include <algorithm>
#include <limits>
#include <variant>

#include "base/as_number.h"
#include "base/console.h"
#include "base/output_file.h"
#include "report/diagram.h"

namespace carom::tools {
namespace {

/// [shots] A plot shows the first ones: more would not change it, but need memory.
constexpr std::size_t kMostPlotted = 1000000;

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

}  // namespace

PlottedSweep::PlottedSweep(const games::Sweep& sweep, const std::string& file)
    : sweep_(sweep), file_(file), values_(sweep.variation().keys().size()) {
    if (file_.empty()) return;
    diagram_format(file_);
    if (sweep.measures().empty() || !sweep.measures().front().is_number())
        throw UsageError(
            "--plot draws the first --measure, which must be a number; see carom describe measures");
    plot_.measure = sweep.measures().front().text();
    for (const games::SweepColumn& column : sweep.columns()) {
        if (column.of != games::SweepColumn::Of::kKey || column.kind == ValueKind::kText) continue;
        if (plot_.axes.size() == 2) break;
        plot_.axes.push_back(column.name + (column.unit.empty() ? "" : " [" + column.unit + "]"));
        keys_.push_back(column.which);
    }
    plot_.heading = plot_.axes.size() < 2                 ? "Shots by"
                    : sweep.measures().front().is_truth() ? "Share of the shots in which this holds:"
                                                          : "Mean of";
    if (plot_.axes.size() == 2) return;
    plot_.axes.clear();
    keys_.clear();
}

void PlottedSweep::add(std::uint64_t shot, double value) {
    if (plot_.shots.size() == kMostPlotted) return;
    PlotShot& plotted = plot_.shots.emplace_back();
    plotted.value = value;
    sweep_.variation().draw(shot, values_);
    for (std::size_t axis = 0; axis < keys_.size(); ++axis)
        plotted.place[axis] = number_of(values_[keys_[axis]]);
}

void PlottedSweep::add(const games::SweptShots& shots) {
    if (file_.empty()) return;
    for (std::size_t i = 0; i < shots.count; ++i)
        if (has_result(shots.outcomes.status[i]))
            add(shots.first + i, std::get<double>(shots.measured[i * sweep_.measures().size()]));
}

void PlottedSweep::add(std::string_view rows) {
    if (file_.empty()) return;
    const std::size_t measure = sweep_.columns().size() - sweep_.measures().size();
    for (; !rows.empty(); rows.remove_prefix(std::min(rows.size(), rows.find('\n') + 1))) {
        const std::vector<std::string_view> cells = cells_of(rows.substr(0, rows.find('\n')));
        if (cells.size() <= measure) continue;
        add(as_number<std::uint64_t>(cells[0]).value_or(0),
            as_number<double>(cells[measure]).value_or(std::numeric_limits<double>::quiet_NaN()));
    }
}

void PlottedSweep::write() const {
    if (file_.empty()) return;
    OutputFile file(file_);
    file.write(draw_plot(plot_, diagram_format(file_)));
    file.commit();
}

}  // namespace carom::tools
