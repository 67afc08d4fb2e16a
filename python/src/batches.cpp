// Many shots: of columns of numbers, and of a sweep.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "batches.h"
#include "carom/engine/batch.h"
#include "carom/engine/sweep_columns.h"
#include "carom/engine/variation.h"
#include "carom/games/measures.h"
#include "measures.h"
#include "native.h"

namespace carom::python {
namespace {

/// Positions of all balls at these times; NaN for balls that a shot lacks.
/// @param path  times x balls x 3
void fill_path(const Record& record, std::span<const double> times, const std::uint8_t* absent,
               std::size_t balls, double* path) {
    thread_local std::vector<double> states;
    const std::size_t there = record.tracks.size();
    states.resize(times.size() * there * 9);
    record.states_at(times, states.data(), nullptr);
    const double* from = states.data();
    for (std::size_t t = 0; t < times.size(); ++t)
        for (std::size_t ball = 0; ball < balls; ++ball, path += 3) {
            if (absent != nullptr && absent[ball] != 0) continue;
            std::copy_n(from, 3, path);
            from += 9;
        }
}

/// @param paths  shots x times x balls x 3 [m], all NaN before, or empty
std::vector<Failure> many(const NativeScene& native, std::size_t shots, const std::vector<Column>& columns,
                          const Flat<const std::uint8_t>& absent, std::optional<double> until,
                          std::optional<std::int64_t> max_events, int threads, const ShotArrays& out,
                          const Flat<const double>& times, const Flat<double>& paths) {
    const std::size_t balls = native.scene->ball.size(), each = times.size() * balls * 3;
    if (paths.size() != shots * each) throw nb::value_error("expected one path for each shot");
    return played_columns(native, columns, absent, until, max_events, threads, out,
                          [&](const Scene& scene, std::span<const BatchColumn> list, kernel::Isa isa,
                              BatchOptions& options, const BatchArrays& into) {
                              if (times.size() > 0)
                                  options.judge = [&](std::size_t shot, const Outcome&,
                                                      const Record& record) {
                                      fill_path(record, {times.data(), times.size()},
                                                absent.size() > 0 ? absent.data() + shot * balls : nullptr,
                                                balls, paths.data() + shot * each);
                                  };
                              return simulate_many(scene, shots, list, isa, options, into);
                          });
}

struct NativeSweep {
    explicit NativeSweep(Variation of) : variation(std::move(of)), columns(sweep_columns(variation)) {}
    NativeSweep(NativeSweep&&) = default;  // measures cannot be copied
    Variation variation;
    std::vector<SweepColumn> columns;  ///< those of the measures last
    std::vector<games::Measure> measures;
};

NativeSweep make_sweep(const NativeScene& scene, const std::vector<std::string>& rules, std::uint64_t seed,
                       const std::vector<std::string>& measures, const std::optional<std::string>& game) {
    try {
        NativeSweep sweep(Variation::from_text(scene.source, scene.scene->file, rules, seed));
        for (const std::string& text : measures) {
            const games::Measure& measure =
                sweep.measures.emplace_back(measure_of(text, sweep.variation.base(), game));
            sweep.columns.push_back(
                {text, measure.is_number() ? ValueKind::kNumber : ValueKind::kText, "", true});
        }
        return sweep;
    } catch (const VariationError& error) {
        throw nb::value_error(error.what());
    }
}

/// A numpy array with the values of a list.
template <class T>
nb::any array_of(std::vector<T>&& list) {
    auto* const kept = new std::vector<T>(std::move(list));
    const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return nb::borrow<nb::any>(
        nb::cast(nb::ndarray<nb::numpy, T, nb::ndim<1>>(kept->data(), {kept->size()}, owner)));
}

/// A column: its array, and its texts if the array holds indices of texts.
std::pair<nb::any, std::vector<std::string>> column_of(ValueKind kind, ColumnValues&& values) {
    if (kind == ValueKind::kNumber) return {array_of(std::move(values.numbers)), {}};
    if (kind == ValueKind::kWhole) return {array_of(std::move(values.wholes)), {}};
    return {array_of(std::move(values.places)), std::move(values.texts)};
}

/// The column of one measure: its values in the order of the shots. Shots without a result have none.
ColumnValues measure_column(const games::Measure& measure, std::span<const games::MeasureValue> measured,
                            std::size_t first, std::size_t step, const ShotStatus* status) {
    ColumnValues column;
    std::map<std::string, std::int32_t> known;
    for (std::size_t at = first, shot = 0; at < measured.size(); at += step, ++shot) {
        if (measure.is_number()) {
            column.numbers.push_back(has_result(status[shot]) ? std::get<double>(measured[at])
                                                              : std::numeric_limits<double>::quiet_NaN());
        } else if (!has_result(status[shot])) {
            column.places.push_back(-1);
        } else {
            const auto [place, is_new] = known.try_emplace(games::text_of(measured[at]), column.texts.size());
            if (is_new) column.texts.push_back(place->first);
            column.places.push_back(place->second);
        }
    }
    return column;
}

/// @return why shots have no result, and the columns
std::pair<std::vector<Failure>, std::vector<std::pair<nb::any, std::vector<std::string>>>> sweep_shots(
    const NativeSweep& sweep, std::uint64_t first, std::size_t shots, int threads, const ShotArrays& out,
    std::uint64_t hash_every) {
    const kernel::Isa isa = chosen_isa();
    const Variation& variation = sweep.variation;
    const std::size_t measures = sweep.measures.size();
    std::vector<games::MeasureValue> measured(shots * measures);
    std::vector<ColumnValues> values;
    std::vector<Failure> failures = played(
        out, variation.base().ball.size(), threads, [&](BatchOptions& options, const BatchArrays& into) {
            options.hash_every = std::max<std::uint64_t>(hash_every, 1);
            if (measures > 0)
                options.judge = [&](std::size_t shot, const Outcome&, const Record& record) {
                    for (std::size_t m = 0; m < measures; ++m)
                        measured[shot * measures + m] = sweep.measures[m].in_table(record);
                };
            std::vector<std::string> draws;
            auto messages = simulate_many(variation, first, shots, isa, options, into, draws);
            values = sweep_values(variation, first, shots, draws, into, messages);
            for (std::size_t m = 0; m < measures; ++m)
                values.push_back(measure_column(sweep.measures[m], measured, m, measures, into.status));
            return messages;
        });
    std::vector<std::pair<nb::any, std::vector<std::string>>> columns;
    for (std::size_t k = 0; k < values.size(); ++k)
        columns.push_back(column_of(sweep.columns[k].kind, std::move(values[k])));
    return {std::move(failures), std::move(columns)};
}

/// Name, kind, unit, and whether shots without a result have none.
std::vector<std::tuple<std::string, std::string, std::string, bool>> column_rows(const NativeSweep& sweep) {
    std::vector<std::tuple<std::string, std::string, std::string, bool>> rows;
    for (const SweepColumn& column : sweep.columns) {
        const char* const kind = column.kind == ValueKind::kNumber  ? "float64"
                                 : column.kind == ValueKind::kWhole ? "int64"
                                                                    : "text";
        rows.emplace_back(column.name, kind, column.unit, column.of_result);
    }
    return rows;
}

}  // namespace

void add_batches(nb::module_& m) {
    m.def("simulate_many", many, nb::arg("scene"), nb::arg("shots"), nb::arg("columns"), nb::arg("absent"),
          nb::arg("until").none(), nb::arg("max_events").none(), nb::arg("threads"),
          nb::arg("out").noconvert(), nb::arg("times").noconvert(), nb::arg("paths").noconvert());
    nb::class_<NativeSweep>(m, "Sweep")
        .def_prop_ro("columns", column_rows)
        .def("play", sweep_shots, nb::arg("first"), nb::arg("shots"), nb::arg("threads"),
             nb::arg("out").noconvert(), nb::arg("hash_every"));
    m.def("make_sweep", make_sweep, nb::arg("scene"), nb::arg("rules"), nb::arg("seed"),
          nb::arg("measures") = std::vector<std::string>(), nb::arg("game") = nb::none());
}

}  // namespace carom::python
