// Many shots: of columns of numbers, and of a sweep.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "batches.h"
#include "carom/engine/batch.h"
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
    Variation variation;
};

NativeSweep make_sweep(const NativeScene& scene, const std::vector<std::string>& rules, std::uint64_t seed) {
    try {
        return {Variation::from_text(scene.source, scene.scene->file, rules, seed)};
    } catch (const VariationError& error) {
        throw nb::value_error(error.what());
    }
}

/// The place of a key among those of a sweep, and where its draws go.
using FloatDraws = std::pair<std::size_t, Flat<double>>;
using WholeDraws = std::pair<std::size_t, Flat<std::int64_t>>;
/// Of a list: for every shot the place of its text among the texts that came, in the order in which they came first.
using ListDraws = std::pair<std::size_t, Flat<std::int32_t>>;

/// Reads the draws of one key, which are every `keys`-th of `texts`; a draw is written so that it reads back to the same bits.
template <class T>
void read_draws(const std::vector<std::string>& texts, std::size_t key, std::size_t keys, T* out) {
    for (std::size_t i = key; i < texts.size(); i += keys)
        std::from_chars(texts[i].data(), texts[i].data() + texts[i].size(), *out++);
}

std::vector<std::string> read_list_draws(const std::vector<std::string>& texts, std::size_t key,
                                         std::size_t keys, std::int32_t* out) {
    std::vector<std::string> names;
    std::unordered_map<std::string_view, std::int32_t> places;
    for (std::size_t i = key; i < texts.size(); i += keys) {
        const auto [place, is_new] = places.emplace(texts[i], static_cast<std::int32_t>(names.size()));
        if (is_new) names.push_back(texts[i]);
        *out++ = place->second;
    }
    return names;
}

/// @return why shots have no result, and the texts of each of `lists`
std::pair<std::vector<Failure>, std::vector<std::vector<std::string>>> sweep_shots(
    const NativeSweep& sweep, std::uint64_t first, std::size_t shots, int threads, const ShotArrays& out,
    const std::vector<FloatDraws>& floats, const std::vector<WholeDraws>& wholes,
    const std::vector<ListDraws>& lists, std::uint64_t hash_every) {
    const kernel::Isa isa = chosen_isa();
    const std::size_t keys = sweep.variation.keys().size();
    std::vector<std::vector<std::string>> names;
    std::vector<Failure> failures =
        played(out, sweep.variation.base().ball.size(), threads,
               [&](BatchOptions& options, const BatchArrays& into) {
                   options.hash_every = std::max<std::uint64_t>(hash_every, 1);
                   std::vector<std::string> texts;
                   auto messages = simulate_many(sweep.variation, first, shots, isa, options, into, texts);
                   for (const auto& [key, draws] : floats) read_draws(texts, key, keys, draws.data());
                   for (const auto& [key, draws] : wholes) read_draws(texts, key, keys, draws.data());
                   for (const auto& [key, draws] : lists)
                       names.push_back(read_list_draws(texts, key, keys, draws.data()));
                   return messages;
               });
    return {std::move(failures), std::move(names)};
}

std::vector<std::string> pocket_ids(const NativeScene& scene) {
    std::vector<std::string> ids;
    for (const Pocket& pocket : scene.scene->table.pockets) ids.push_back(pocket.id);
    return ids;
}

}  // namespace

void add_batches(nb::module_& m) {
    nb::class_<ShotArrays>(m, "ShotArrays")
        .def(
            "__init__",
            [](ShotArrays* self, Flat<std::uint8_t> status, Flat<double> duration, Flat<std::int64_t> events,
               Flat<std::int32_t> first_hit, Flat<std::int32_t> contacts,
               Flat<std::int32_t> approach_cushions, Flat<double> xy, Flat<std::int32_t> pocket,
               Flat<std::int32_t> fell, Flat<std::int32_t> cushions, Flat<std::uint64_t> hash) {
                new (self) ShotArrays{std::move(status),    std::move(duration), std::move(events),
                                      std::move(first_hit), std::move(contacts), std::move(approach_cushions),
                                      std::move(xy),        std::move(pocket),   std::move(fell),
                                      std::move(cushions),  std::move(hash)};
            },
            nb::arg("status").noconvert(), nb::arg("duration").noconvert(), nb::arg("events").noconvert(),
            nb::arg("first_hit").noconvert(), nb::arg("contacts").noconvert(),
            nb::arg("approach_cushions").noconvert(), nb::arg("xy").noconvert(),
            nb::arg("pocket").noconvert(), nb::arg("fell").noconvert(), nb::arg("cushions").noconvert(),
            nb::arg("hash").noconvert());
    m.def("simulate_many", many, nb::arg("scene"), nb::arg("shots"), nb::arg("columns"), nb::arg("absent"),
          nb::arg("until").none(), nb::arg("max_events").none(), nb::arg("threads"), nb::arg("out"));
    nb::class_<NativeSweep>(m, "Sweep")
        .def_prop_ro("keys", [](const NativeSweep& s) { return s.variation.keys(); })
        .def_prop_ro("fingerprint", [](const NativeSweep& s) { return s.variation.fingerprint(); })
        .def("unit", [](const NativeSweep& s, std::size_t key) { return s.variation.unit(key); })
        .def("play", sweep_shots, nb::arg("first"), nb::arg("shots"), nb::arg("threads"), nb::arg("out"),
             nb::arg("floats"), nb::arg("wholes"), nb::arg("lists"), nb::arg("hash_every"));
    m.def("make_sweep", make_sweep);
    m.def("pocket_ids", pocket_ids);
}

}  // namespace carom::python
