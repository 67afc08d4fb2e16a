// Many shots: of columns of numbers, and of a sweep.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "batches.h"
#include "carom/engine/batch.h"
#include "carom/engine/variation.h"
#include "carom/games/sweep.h"
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

games::Sweep make_sweep(const NativeScene& scene, const std::vector<std::string>& rules, std::uint64_t seed,
                        const std::vector<std::string>& measures, const std::optional<std::string>& game) {
    try {
        return {Variation::from_text(scene.source, scene.scene->file, rules, seed), measures,
                game_or_none(game)};
    } catch (const VariationError& error) {
        throw nb::value_error(error.what());
    } catch (const games::MeasureError& error) {
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

struct ColumnValues {
    // For texts, the index of each in `texts`, -1 for none.
    std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::int32_t>> values;
    std::vector<std::string> texts;  // each once
    std::vector<std::uint8_t> missing;
};

ColumnValues values_of(const games::Sweep& sweep, const games::SweepColumn& column,
                       const games::SweptShots& shots) {
    ColumnValues of;
    std::unordered_map<std::string, std::int32_t> known;
    const auto add = [&](auto& list, auto none, const auto& read) {
        for (std::size_t shot = 0; shot < shots.count; ++shot) {
            const games::SweepValue value = sweep.value(column, shots, shot);
            list.push_back(value.index() == 0 ? none : read(value));
            // NaN differs from itself.
            of.missing.push_back(value.index() == 0 || list.back() != list.back());
        }
    };
    if (column.kind == ValueKind::kNumber)
        add(of.values.emplace<0>(), std::nan(""), [](const auto& value) { return std::get<double>(value); });
    else if (column.kind == ValueKind::kWhole)
        add(of.values.emplace<1>(), std::int64_t{0},
            [](const auto& value) { return std::get<std::int64_t>(value); });
    else
        add(of.values.emplace<2>(), -1, [&](const auto& value) {
            const auto& text = std::get<std::string>(value);
            const auto [place, is_new] = known.try_emplace(text, static_cast<std::int32_t>(known.size()));
            if (is_new) of.texts.push_back(text);
            return place->second;
        });
    return of;
}

/// Its array, with the indices of texts if it has any; its texts; and for each shot whether its value is
/// missing, unless none can be.
using SweepArrays = std::tuple<nb::any, std::optional<std::vector<std::string>>, nb::any>;

SweepArrays arrays_of(const games::SweepColumn& column, ColumnValues&& of) {
    nb::any missing = nb::borrow<nb::any>(nb::none());
    if (column.of_result || column.kind == ValueKind::kNumber) missing = array_of(std::move(of.missing));
    std::optional<std::vector<std::string>> texts;
    if (column.kind == ValueKind::kText) texts = std::move(of.texts);
    nb::any values = std::visit([](auto& list) { return array_of(std::move(list)); }, of.values);
    return {std::move(values), std::move(texts), std::move(missing)};
}

/// @return the columns, the status of each shot, and the hashes if they are wanted
std::tuple<std::vector<SweepArrays>, nb::any, nb::any> sweep_shots(const games::Sweep& sweep,
                                                                   std::uint64_t first, std::size_t count,
                                                                   int threads, bool hashes) {
    const kernel::Isa isa = chosen_isa();
    Batch batch(count, sweep.variation().base().ball.size(), hashes);
    std::vector<ColumnValues> values;
    try {
        interruptible([&](std::function<bool()> interrupted) {
            BatchOptions options;
            options.threads = threads;
            options.stop = std::move(interrupted);
            const games::SweptShots shots = sweep.play(first, count, isa, options, batch);
            for (const games::SweepColumn& column : sweep.columns())
                values.push_back(values_of(sweep, column, shots));
        });
    } catch (const games::MeasureError& error) {
        throw nb::value_error(error.what());
    }
    std::vector<SweepArrays> columns;
    for (std::size_t k = 0; k < values.size(); ++k)
        columns.push_back(arrays_of(sweep.columns()[k], std::move(values[k])));
    std::vector<std::uint8_t> status;
    for (std::size_t i = 0; i < count; ++i) status.push_back(static_cast<std::uint8_t>(batch.status[i]));
    std::vector<std::uint64_t> hash(batch.hash, batch.hash + (hashes ? count : 0));
    return {std::move(columns), array_of(std::move(status)), array_of(std::move(hash))};
}

/// Name, kind and unit.
std::vector<std::tuple<std::string, std::string, std::string>> column_rows(const games::Sweep& sweep) {
    std::vector<std::tuple<std::string, std::string, std::string>> rows;
    for (const games::SweepColumn& column : sweep.columns()) {
        const char* const kind = column.kind == ValueKind::kNumber  ? "float64"
                                 : column.kind == ValueKind::kWhole ? "int64"
                                                                    : "text";
        rows.emplace_back(column.name, kind, column.unit);
    }
    return rows;
}

/// Name, type, numbers of each ball (0: one of the shot), unit, and whether it is on request.
auto outcome_rows() {
    std::vector<std::tuple<std::string, std::string, std::size_t, std::string, bool>> rows;
    for (const OutcomeColumn& c : kOutcomeColumns)
        rows.emplace_back(c.name, name(c.type), c.per_ball, c.unit, c.on_request);
    return rows;
}

}  // namespace

void add_batches(nb::module_& m) {
    m.def("simulate_many", many, nb::arg("scene"), nb::arg("shots"), nb::arg("columns"), nb::arg("absent"),
          nb::arg("until").none(), nb::arg("max_events").none(), nb::arg("threads"),
          nb::arg("out").noconvert(), nb::arg("times").noconvert(), nb::arg("paths").noconvert());
    m.def("outcome_columns", outcome_rows);
    nb::class_<games::Sweep>(m, "Sweep")
        .def_prop_ro("columns", column_rows)
        .def("play", sweep_shots, nb::arg("first"), nb::arg("shots"), nb::arg("threads"), nb::arg("hashes"));
    m.def("make_sweep", make_sweep, nb::arg("scene"), nb::arg("rules"), nb::arg("seed"),
          nb::arg("measures") = std::vector<std::string>(), nb::arg("game") = nb::none());
}

}  // namespace carom::python
