// Measures of shots, details of events, and searches for a shot.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "batches.h"
#include "carom/engine/batch.h"
#include "carom/engine/event_details.h"
#include "carom/games/break.h"
#include "carom/games/measures.h"
#include "carom/games/refine.h"
#include "carom/games/solve.h"
#include "measures.h"
#include "native.h"
#include "values.h"

namespace carom::python {

std::optional<games::Game> game_or_none(const std::optional<std::string>& game) {
    return game ? std::optional(games::game_named(*game)) : std::nullopt;
}

namespace {

games::Measure measure_of(const std::string& text, const Scene& scene,
                          const std::optional<std::string>& game) {
    try {
        return {text, scene, game_or_none(game)};
    } catch (const games::MeasureError& error) {
        throw nb::value_error(error.what());
    }
}

using Rows = std::vector<std::tuple<std::string, std::string, std::string>>;

Rows event_columns_rows() {
    Rows rows;
    for (const EventColumn& column : event_columns())
        rows.emplace_back(column.name, column.unit, column.what);
    return rows;
}

/// The numbers of event_columns() for every event, event after event.
void event_details(const NativeRecord& r, const Flat<double>& out) {
    const std::size_t columns = event_columns().size(), events = r.record->events.size();
    if (out.size() != columns * events) throw nb::value_error("expected one row for each event");
    double* const to = out.data();
    const nb::gil_scoped_release no_gil;
    for (std::size_t i = 0; i < events; ++i) event_row(*r.record, i, std::span(to + i * columns, columns));
}

std::vector<std::string> met_names(const NativeRecord& r) {
    std::vector<std::string> names;
    for (const Event& event : r.record->events) names.push_back(met_name(*r.record, event));
    return names;
}

std::vector<std::tuple<std::string, std::string, std::string, std::string>> measure_rows() {
    std::vector<std::tuple<std::string, std::string, std::string, std::string>> rows;
    for (const games::MeasureInfo& m : games::measures())
        rows.emplace_back(m.name, m.arguments, m.unit, m.what);
    return rows;
}

/// The value, and whether it is 0 or 1.
std::pair<games::MeasureValue, bool> measured(const NativeRecord& r, const NativeScene* other,
                                              const std::string& text,
                                              const std::optional<std::string>& game) {
    const games::Measure measure = measure_of(text, scene_of(r, other), game);
    try {
        return {measure.of(*r.record), measure.is_truth()};
    } catch (const std::invalid_argument& error) {
        throw nb::value_error(error.what());
    }
}

using ChoiceRow = std::tuple<std::string, double, double>;
/// The members of carom.Solution.
using SolutionRow = std::tuple<double, std::pair<double, double>, std::size_t, nb::any, nb::any, nb::any,
                               NativeScene, double, std::string, double, std::vector<double>>;

games::SolveOptions options_of(nb::handle hand, nb::handle unknown, std::size_t shots, std::size_t best,
                               std::uint64_t seed, int threads) {
    games::SolveOptions options;
    options.hand = taken<games::Hand>(hand, "hand");
    options.unknown = taken<games::Unknown>(unknown, "unknown");
    options.shots = shots;
    options.best = best;
    options.seed = seed;
    options.threads = threads;
    return options;
}

std::vector<SolutionRow> found(const Scene& scene, const games::Measure& want, kernel::Isa isa,
                               games::SolveOptions options, bool exact = false) {
    std::vector<games::Exact> moved;
    std::vector<double> searches;
    const std::vector<games::Solution> solutions = interruptible([&](std::function<bool()> stop) {
        options.stop = std::move(stop);
        if (exact && want.places().empty())
            throw std::invalid_argument(
                "exact=True: the goal has no place; add one, as in \"cue near (0.6, 1.2, 0.05)\"");
        std::vector<games::Solution> best = games::solve(scene, want, isa, options, &searches);
        for (std::size_t i = 0; exact && i < best.size(); ++i)
            moved.push_back(games::exact(best[i], want, isa, options));
        return best;
    });
    std::vector<SolutionRow> rows;
    for (std::size_t i = 0; i < solutions.size(); ++i) {
        const bool is_moved = exact && moved[i].solution;
        const games::Solution& solution = is_moved ? *moved[i].solution : solutions[i];
        const std::vector<games::Choice>& choices = is_moved ? moved[i].choices : options.choices;
        nb::dict values;
        for (std::size_t k = 0; k < choices.size(); ++k) values[choices[k].key.c_str()] = solution.values[k];
        const games::Share share = games::share_of(solution.successes, solution.shots);
        rows.emplace_back(
            share.value, std::pair(share.low, share.high), solution.shots, nb::borrow<nb::any>(values),
            given(solution.falls), given(solution.costs),
            NativeScene{std::make_shared<const Scene>(solution.scene), scene_text(solution.scene)},
            exact ? moved[i].refined.miss : std::numeric_limits<double>::quiet_NaN(),
            exact ? moved[i].refined.trouble : "", games::share_of(solution.exact, solution.shots).value,
            searches);
    }
    return rows;
}

std::vector<SolutionRow> solve(const NativeScene& native, const std::string& want,
                               const std::optional<std::string>& game, const std::vector<ChoiceRow>& choices,
                               nb::handle hand, nb::handle unknown, int layouts, std::size_t shots,
                               std::size_t best, std::uint64_t seed, int threads, bool exact) {
    games::SolveOptions options = options_of(hand, unknown, shots, best, seed, threads);
    for (const auto& [key, low, high] : choices) options.choices.push_back({key, low, high});
    options.racks = games::racks_of(native.source, native.scene->file, layouts, seed);
    if (exact && options.racks)
        throw nb::value_error("exact=True: the racks differ, so no shot is exact for all; use layouts=1");
    return found(*native.scene, measure_of(want, *native.scene, game), chosen_isa(), std::move(options),
                 exact);
}

std::vector<SolutionRow> best_break(const std::string& game, const std::string& table,
                                    const std::string& rack, double radius_sd, double speed_max, bool box,
                                    nb::handle hand, nb::handle unknown, std::size_t shots, std::size_t best,
                                    std::uint64_t seed, int threads) {
    games::BreakOptions wanted{game, table, rack, radius_sd, speed_max, box, seed};
    games::BreakSearch search;
    try {
        search = games::break_search(wanted);
    } catch (const std::invalid_argument& error) {
        throw nb::value_error(error.what());
    }
    games::SolveOptions options = options_of(hand, unknown, shots, best, seed, threads);
    options.choices = search.choices;
    options.racks = search.racks;
    const games::Measure want(search.want, search.scene, search.game);
    return found(search.scene, want, chosen_isa(), std::move(options));
}

}  // namespace

void add_measures(nb::module_& m) {
    m.def("event_columns", event_columns_rows);
    m.def("event_details", event_details, nb::arg("record"), nb::arg("out").noconvert());
    m.def("met_names", met_names);
    m.def("measures", measure_rows);
    m.def("measured", measured, nb::arg("record"), nb::arg("scene").none(), nb::arg("text"),
          nb::arg("game").none());
    m.def("solve", solve, nb::arg("scene"), nb::arg("want"), nb::arg("game").none(), nb::arg("choices"),
          nb::arg("hand"), nb::arg("unknown"), nb::arg("layouts"), nb::arg("shots"), nb::arg("best"),
          nb::arg("seed"), nb::arg("threads"), nb::arg("exact"));
    m.def("best_break", best_break, nb::arg("game"), nb::arg("table"), nb::arg("rack"), nb::arg("radius_sd"),
          nb::arg("speed_max"), nb::arg("box"), nb::arg("hand"), nb::arg("unknown"), nb::arg("shots"),
          nb::arg("best"), nb::arg("seed"), nb::arg("threads"));
    m.def("default_choices", [] {
        std::vector<ChoiceRow> rows;
        for (const games::Choice& c : games::default_choices()) rows.emplace_back(c.key, c.low, c.high);
        return rows;
    });
    m.def("break_games",
          [] { return std::vector<std::string>(games::kBreakGames.begin(), games::kBreakGames.end()); });
}

}  // namespace carom::python
