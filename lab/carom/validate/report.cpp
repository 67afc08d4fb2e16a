#include "validate/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/console.h"

namespace carom::tools {
namespace {

/// "within", or the deviation from the claimed value: "27 % low", "0.06 m off".
std::string claim_text(const ValidationRow& row) {
    if (!row.claim) return "within";
    const double measured = row.measured->value, off = *row.claim - measured;
    const char* unit = info(row.measured->quantity).unit;
    if (is_of_many(row.measured->quantity)) return fmt::format("{:.2f}", *row.claim);
    const bool part = measured != 0.0 && row.measured->quantity != Quantity::kDirection;
    const double size = part ? 100.0 * std::abs(off / measured) : std::abs(off);
    return fmt::format("{:.2g} {} {}", size, part ? "%" : unit,
                       measured == 0.0 ? "off"
                       : off < 0.0     ? "low"
                                       : "high");
}

/// "speed (rolled), ball 1"
std::string quantity_text(const Measured& m) {
    if (!m.name.empty()) return m.name;
    std::string text = info(m.quantity).name;
    if (is_of_many(m.quantity)) return text;
    const char* when = kInstants[static_cast<std::size_t>(m.when)];
    text += m.after == 0.0              ? fmt::format(" ({})", when)
            : m.when == Instant::kStart ? fmt::format(" ({:g} s)", m.after)
                                        : fmt::format(" ({} + {:g} s)", when, m.after);
    return m.ball == "cue" ? text : text + ", ball " + m.ball;
}

Table case_table(const std::vector<ValidationRow>& rows, const ValidationCase& of) {
    std::size_t shot = 5, quantity = 9, variant = 7;
    for (const ValidationRow& row : rows) {
        if (row.of != &of) continue;
        shot = std::max(shot, row.shot->name.size());
        quantity = std::max(quantity, quantity_text(*row.measured).size());
        variant = std::max(variant, row.variant->name.size());
    }
    const auto left = [](std::size_t width) { return fmt::format("<{}", width + 2); };
    Table table(Column("", "  shot", left(shot + 2)), Column("", "quantity", left(quantity)),
                Column("", "measured", ">8.3f"), Column("", "+-", ">8.3f"), Column("", "unit", ">6"),
                Column("", "", "<2"), Column("", "variant", left(variant)), Column("", "model", "<15"),
                Column("", "computed", ">8.3f"), Column("", "in +-", ">8.1f"));
    const Measured* last = nullptr;
    for (const ValidationRow& row : rows) {
        if (row.of != &of) continue;
        const Measured& m = *row.measured;
        const bool again = last == &m;  // the number is in the line of its first variant
        last = &m;
        const auto once = [again](const auto& value) { return again ? Cell(" ") : Cell(value); };
        table.add(
            {once("  " + row.shot->name), once(quantity_text(m)), once(m.value), once(row.uncertainty),
             once(info(m.quantity).unit), " ", row.variant->name, row.model, row.computed, row.deviation()},
            row.as_claimed() ? (row.within() ? "" : "  *")
                             : fmt::format("  NOT AS CLAIMED ({})", claim_text(row)));
    }
    return table;
}

std::vector<const ValidationCase*> cases_of(const std::vector<ValidationRow>& rows) {
    std::vector<const ValidationCase*> cases;
    for (const ValidationRow& row : rows)
        if (cases.empty() || cases.back() != row.of) cases.push_back(row.of);
    return cases;
}

/// The curve through a variant's points of one group.
Series series_of(const std::string& name, const std::vector<ValidationRow>& rows, const CasePlot& plot,
                 bool measured, const std::function<bool(const ValidationRow&)>& belongs) {
    Series series{name, {}, !measured && !plot.x.empty(), true, false, -1, {}};
    const auto number = [](const ValidationShot& shot, const std::string& key) {
        for (const auto& [name_of, text] : shot.values)
            if (name_of == key) return std::stod(text);
        return 1.0;
    };
    for (const ValidationRow& row : rows) {
        const Quantity shown = row.of->shots.front().measured.front().quantity;
        if (row.measured != &row.shot->measured.front() || row.measured->quantity != shown || !belongs(row))
            continue;
        const double over = plot.over.empty() ? 1.0 : number(*row.shot, plot.over);
        const double place = static_cast<double>(row.shot - row.of->shots.data()) + 1.0;
        // Variants are drawn side by side if there is room.
        const double step = 0.08 * static_cast<double>(row.variant - row.of->variants.data() + 1);
        const double x = plot.x.empty() ? place + (measured ? 0.0 : step) : number(*row.shot, plot.x);
        series.points.emplace_back(x, (measured ? row.measured->value : row.computed) / over);
        if (measured) series.errors.push_back(row.measured->uncertainty / over);
    }
    if (series.line) std::sort(series.points.begin(), series.points.end());
    return series;
}

std::vector<std::string> groups_of(const ValidationCase& of) {
    std::vector<std::string> groups;
    for (const ValidationShot& shot : of.shots)
        if (std::find(groups.begin(), groups.end(), shot.group) == groups.end()) groups.push_back(shot.group);
    return groups;
}

Plot case_plot(const std::vector<ValidationRow>& rows) {
    const ValidationCase& of = *rows.front().of;
    Plot plot;
    plot.title = fmt::format("{}: {}", of.id, of.title);
    plot.notes = {fmt::format("{}; {}", of.source, of.trust)};
    plot.x = {of.plot->x_title, false, {}, {}, {}};
    plot.y = {of.plot->y_title, false, {}, {}, {}};
    if (of.sweep) plot.y.low = 0.0;
    if (of.plot->x.empty())
        for (std::size_t i = 0; i < of.shots.size(); ++i)
            plot.x.marks.emplace_back(static_cast<double>(i) + 1.0, of.shots[i].name);
    for (const std::string& group : groups_of(of)) {
        const auto title = [&group](const std::string& name) {
            return group.empty() ? name : fmt::format("{}, {}", name, group);
        };
        const Variant* first = &of.variants.front();
        Series measured = series_of(title("measured"), rows, *of.plot, true, [&](const ValidationRow& row) {
            return row.shot->group == group && row.variant == first;
        });
        measured.colour = 6;
        plot.series.push_back(measured);
        int colour = 0;
        for (const Variant& variant : of.variants) {
            Series series =
                series_of(title(variant.name), rows, *of.plot, false, [&](const ValidationRow& row) {
                    return row.shot->group == group && row.variant == &variant;
                });
            series.colour = colour++ % 6;
            series.dashed = group != of.shots.front().group;
            plot.series.push_back(series);
        }
    }
    return plot;
}

/// Differences in units of the uncertainty: one column per case or, for a single case, per number.
Plot overview(const std::vector<ValidationRow>& rows) {
    constexpr double kFarthest = 10.0;
    double edge = 2.0;
    for (const ValidationRow& row : rows)
        edge = std::max(edge, std::min(std::abs(row.deviation()), kFarthest));
    const bool one = rows.front().of == rows.back().of;
    Plot plot;
    plot.title = one ? fmt::format("{}: {}", rows.front().of->id, rows.front().of->title)
                     : "Computed - measured, in units of the uncertainty";
    plot.notes = {fmt::format("within is from -1 to 1; what is beyond {:g} is drawn at the edge", kFarthest)};
    plot.x = {one ? "number, in the order of the case" : "case", false, {}, {}, {}};
    plot.y = {"(computed - measured) / uncertainty", false, -edge - 0.5, edge + 0.5, {}};
    const Series points{"", {}, false, true, false, -1, {}};
    plot.series = {points, points, points};
    plot.series[0].name = "other keys and models";
    plot.series[1].name = "former presets";
    plot.series[2].name = "presets";
    const auto column_of = [one](const ValidationRow& row) -> const void* {
        if (one) return row.measured;
        return row.of;
    };
    double column = 0.0;
    for (auto from = rows.begin(); from != rows.end(); column += 1.0) {
        const auto to = std::find_if(
            from, rows.end(), [&](const ValidationRow& row) { return column_of(row) != column_of(*from); });
        plot.x.marks.emplace_back(column + 0.5, one ? fmt::format("{}", column + 1.0) : from->of->id);
        for (auto row = from; row != to; ++row) {
            const std::string& preset = row->variant->preset;
            const bool former = preset.ends_with("_classic");
            const std::size_t series = !row->variant->own_keys().empty() ? 0 : former ? 1 : 2;
            const double part = (static_cast<double>(row - from) + 0.5) / static_cast<double>(to - from);
            plot.series[series].points.emplace_back(column + 0.1 + 0.8 * part,
                                                    std::clamp(row->deviation(), -kFarthest, kFarthest));
        }
        from = to;
    }
    plot.levels = {{"", 1.0}, {"", -1.0}};
    return plot;
}

/// "presets as they ship: 14 of 14 free numbers within (rms 0.6), ..."
std::string totals_text(const std::vector<ValidationRow>& rows) {
    struct Total {
        const char* name;
        int within = 0, count = 0;
        double squares = 0.0;
    } totals[] = {{"free"}, {"fitted"}, {"in words"}};
    for (const ValidationRow& row : rows) {
        if (!row.variant->is_shipped()) continue;
        Total& total = totals[row.measured->kind == kKinds[2] ? 2 : row.variant->free_of_fit ? 0 : 1];
        ++total.count;
        total.within += row.within() ? 1 : 0;
        total.squares += row.deviation() * row.deviation();
    }
    std::string text = "presets as they ship:";
    for (const Total& total : totals)
        if (total.count > 0)
            text +=
                fmt::format("{} {} {} of {} within, rms {:.2f} uncertainties", text.ends_with(':') ? "" : ";",
                            total.name, total.within, total.count, std::sqrt(total.squares / total.count));
    return text + "\n";
}

}  // namespace

Table validation_table(const std::vector<ValidationRow>& rows) {
    using Row = ValidationRow;
    const auto shot_only = [](const Row& r, const Cell& value) {
        return is_of_many(r.measured->quantity) ? Cell() : value;
    };
    const std::pair<const char*, std::function<Cell(const Row&)>> columns[] = {
        {"case", [](const Row& r) { return Cell(r.of->id); }},
        {"title", [](const Row& r) { return Cell(r.of->title); }},
        {"shot", [](const Row& r) { return Cell(r.shot->name); }},
        {"quantity", [](const Row& r) { return Cell(info(r.measured->quantity).name); }},
        {"unit", [](const Row& r) { return Cell(info(r.measured->quantity).unit); }},
        {"ball", [&](const Row& r) { return shot_only(r, r.measured->ball); }},
        {"when", [&](const Row& r) { return shot_only(r, kInstants[static_cast<int>(r.measured->when)]); }},
        {"after", [&](const Row& r) { return shot_only(r, r.measured->after); }},
        {"variant", [](const Row& r) { return Cell(r.variant->name); }},
        {"preset", [](const Row& r) { return Cell(r.variant->preset); }},
        {"model", [](const Row& r) { return Cell(r.model); }},
        {"keys", [](const Row& r) { return Cell(r.variant->own_keys()); }},
        {"differs", [](const Row& r) { return Cell(r.differs); }},
        {"measured", [](const Row& r) { return Cell(r.measured->value); }},
        {"uncertainty", [](const Row& r) { return Cell(r.uncertainty); }},
        {"computed", [](const Row& r) { return Cell(r.computed); }},
        {"difference", [](const Row& r) { return Cell(r.deviation()); }},
        {"within", [](const Row& r) { return Cell(r.within()); }},
        {"claim", [](const Row& r) { return r.claim ? Cell(*r.claim) : Cell("within"); }},
        {"as_claimed", [](const Row& r) { return Cell(r.as_claimed()); }},
        {"kind", [](const Row& r) { return Cell(r.measured->kind); }},
        {"free_of_fit", [](const Row& r) { return Cell(r.variant->free_of_fit); }},
        {"trust", [](const Row& r) { return Cell(r.of->trust); }},
        {"source", [](const Row& r) { return Cell(r.of->source); }},
        {"note", [](const Row& r) { return Cell(r.measured->note); }},
    };
    Table table;
    for (const auto& [key, value] : columns) table.columns.emplace_back(key);
    for (const Row& row : rows) {
        table.rows.emplace_back();
        for (const auto& [key, value] : columns) table.rows.back().cells.push_back(value(row));
    }
    return table;
}

std::string validation_text(const std::vector<ValidationRow>& rows) {
    std::string text;
    for (const ValidationCase* of : cases_of(rows)) {
        text += fmt::format("{}  {}\n  {} ({})\n", of->id, of->title, of->source, of->trust);
        if (!of->note.empty()) text += fmt::format("  {}\n", of->note);
        for (const Variant& variant : of->variants) {
            if (const std::string keys = variant.own_keys(); !keys.empty())
                text += fmt::format("  {} is {} with {}\n", variant.name, variant.preset, keys);
            const auto row = std::find_if(rows.begin(), rows.end(),
                                          [&](const ValidationRow& r) { return r.variant == &variant; });
            if (!row->differs.empty())
                text +=
                    fmt::format("  {} differs from the shipped preset by {}\n", variant.name, row->differs);
        }
        text += table_text(case_table(rows, *of)) + '\n';
    }
    const auto count = [&rows](auto&& is) { return std::count_if(rows.begin(), rows.end(), is); };
    const auto within = count([](const ValidationRow& row) { return row.within(); });
    const auto claimed = count([](const ValidationRow& row) { return row.as_claimed(); });
    text += fmt::format("{} of {} within the uncertainty; * is not, and known; ", within,
                        counted(rows.size(), "number"));
    const auto other = static_cast<long>(rows.size()) - claimed;
    return text + (other == 0 ? "all as claimed\n" : fmt::format("{} not as claimed\n", other)) +
           totals_text(rows);
}

std::string validation_json(const std::vector<ValidationRow>& rows) {
    const nlohmann::ordered_json all = {{"cases", table_json(validation_table(rows))}};
    return all.dump() + "\n";
}

Plot validation_plot(const std::vector<ValidationRow>& rows) {
    return rows.front().of == rows.back().of && rows.front().of->plot ? case_plot(rows) : overview(rows);
}

}  // namespace carom::tools
