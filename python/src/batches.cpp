// Many shots: of columns of numbers, and of a sweep.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "batches.h"
#include "carom/engine/batch.h"
#include "carom/engine/sweep_columns.h"
#include "carom/engine/variation.h"
#include "native.h"

namespace carom::python {
namespace {

std::vector<Failure> many(const NativeScene& native, std::size_t shots, const std::vector<Column>& columns,
                          const Flat<const std::uint8_t>& absent, std::optional<double> until,
                          std::optional<std::int64_t> max_events, int threads, const ShotArrays& out) {
    return played_columns(native, columns, absent, until, max_events, threads, out,
                          [shots](const Scene& scene, std::span<const BatchColumn> list, kernel::Isa isa,
                                  const BatchOptions& options, const BatchArrays& into) {
                              return simulate_many(scene, shots, list, isa, options, into);
                          });
}

struct NativeSweep {
    explicit NativeSweep(Variation of) : variation(std::move(of)), columns(sweep_columns(variation)) {}
    Variation variation;
    std::vector<SweepColumn> columns;
};

NativeSweep make_sweep(const NativeScene& scene, const std::vector<std::string>& rules, std::uint64_t seed) {
    try {
        return NativeSweep(Variation::from_text(scene.source, scene.scene->file, rules, seed));
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

/// @return why shots have no result, and the columns
std::pair<std::vector<Failure>, std::vector<std::pair<nb::any, std::vector<std::string>>>> sweep_shots(
    const NativeSweep& sweep, std::uint64_t first, std::size_t shots, int threads, const ShotArrays& out,
    std::uint64_t hash_every) {
    const kernel::Isa isa = chosen_isa();
    const Variation& variation = sweep.variation;
    std::vector<ColumnValues> values;
    std::vector<Failure> failures = played(
        out, variation.base().ball.size(), threads, [&](BatchOptions& options, const BatchArrays& into) {
            options.hash_every = std::max<std::uint64_t>(hash_every, 1);
            std::vector<std::string> draws;
            auto messages = simulate_many(variation, first, shots, isa, options, into, draws);
            values = sweep_values(variation, first, shots, draws, into, messages);
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
          nb::arg("out").noconvert());
    nb::class_<NativeSweep>(m, "Sweep")
        .def_prop_ro("columns", column_rows)
        .def("play", sweep_shots, nb::arg("first"), nb::arg("shots"), nb::arg("threads"),
             nb::arg("out").noconvert(), nb::arg("hash_every"));
    m.def("make_sweep", make_sweep);
}

}  // namespace carom::python
