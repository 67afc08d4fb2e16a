// Many shots: of columns of numbers, and of a sweep.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/batch.h"
#include "carom/engine/variation.h"
#include "native.h"

namespace carom::python {
namespace {

/// Arrays of the caller's, contiguous, of n and of n x balls (x and y alternate). Shots in _simulate.py makes and checks them.
struct ShotArrays {
    Flat<std::uint8_t> status;
    Flat<double> duration;
    Flat<std::int64_t> events;
    Flat<std::int32_t> first_hit;
    Flat<double> xy;
    Flat<std::int32_t> pocket, fell, cushions;
    Flat<std::uint64_t> hash;  ///< empty: not wanted

    BatchArrays arrays() const {
        BatchArrays out;
        out.status = reinterpret_cast<ShotStatus*>(status.data());
        out.duration = duration.data();
        out.events = events.data();
        out.first_hit = first_hit.data();
        out.x = xy.data();
        out.y = xy.data() + 1;
        out.place_stride = 2;
        out.pocket = pocket.data();
        out.fell = fell.data();
        out.cushions = cushions.data();
        if (hash.size() > 0) out.hash = hash.data();
        return out;
    }
};

using Column = std::pair<std::string, Flat<const double>>;
/// A shot without a result, and why it has none.
using Failure = std::pair<std::size_t, std::string>;

/// Plays a batch without the GIL. Ctrl-C ends it.
template <class Play>
std::vector<Failure> played(const ShotArrays& arrays, std::size_t balls, int threads, Play&& play) {
    const BatchArrays out = arrays.arrays();
    SignalWatch watch;
    BatchOptions options;
    options.threads = threads;
    options.stop = [&watch] { return watch.stopped(); };
    std::vector<Failure> failures;
    try {
        const nb::gil_scoped_release no_gil;
        for (Batch::Message& message : play(options, out)) {
            constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
            out.duration[message.shot] = kNone;
            std::fill_n(out.x + message.shot * balls * 2, 2 * balls, kNone);
            failures.emplace_back(message.shot, std::move(message.text));
        }
    } catch (const BatchStopped&) {
        throw nb::python_error();
    } catch (const std::invalid_argument& error) {
        throw nb::value_error(error.what());
    }
    return failures;
}

std::vector<Failure> many(const NativeScene& native, std::size_t shots, const std::vector<Column>& columns,
                          const Flat<const std::uint8_t>& absent, std::optional<double> until,
                          std::optional<std::int64_t> max_events, int threads, const ShotArrays& out) {
    const kernel::Isa isa = chosen_isa();
    std::vector<BatchColumn> list;
    for (const auto& [key, values] : columns) list.push_back({key, std::span(values.data(), values.size())});
    const std::span left_out(absent.data(), absent.size());
    return played(out, native.scene->ball.size(), threads,
                  [&](BatchOptions& options, const BatchArrays& into) {
                      Scene scene = *native.scene;
                      scene.stop.events = fewer(scene.stop.events, max_events);
                      options.simulate.until = until;
                      options.absent = left_out;
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

std::pair<std::vector<std::string>, std::vector<Failure>> sweep_shots(const NativeSweep& sweep,
                                                                      std::uint64_t first, std::size_t shots,
                                                                      int threads, const ShotArrays& out) {
    const kernel::Isa isa = chosen_isa();
    std::vector<std::string> values;
    std::vector<Failure> failures =
        played(out, sweep.variation.base().ball.size(), threads,
               [&](const BatchOptions& options, const BatchArrays& into) {
                   return simulate_many(sweep.variation, first, shots, isa, options, into, values);
               });
    return {std::move(values), std::move(failures)};
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
               Flat<std::int32_t> first_hit, Flat<double> xy, Flat<std::int32_t> pocket,
               Flat<std::int32_t> fell, Flat<std::int32_t> cushions, Flat<std::uint64_t> hash) {
                new (self) ShotArrays{std::move(status),    std::move(duration), std::move(events),
                                      std::move(first_hit), std::move(xy),       std::move(pocket),
                                      std::move(fell),      std::move(cushions), std::move(hash)};
            },
            nb::arg("status").noconvert(), nb::arg("duration").noconvert(), nb::arg("events").noconvert(),
            nb::arg("first_hit").noconvert(), nb::arg("xy").noconvert(), nb::arg("pocket").noconvert(),
            nb::arg("fell").noconvert(), nb::arg("cushions").noconvert(), nb::arg("hash").noconvert());
    m.def("simulate_many", many, nb::arg("scene"), nb::arg("shots"), nb::arg("columns"), nb::arg("absent"),
          nb::arg("until").none(), nb::arg("max_events").none(), nb::arg("threads"), nb::arg("out"));
    nb::class_<NativeSweep>(m, "Sweep")
        .def_prop_ro("keys", [](const NativeSweep& s) { return s.variation.keys(); })
        .def_prop_ro("fingerprint", [](const NativeSweep& s) { return s.variation.fingerprint(); })
        .def("play", sweep_shots, nb::arg("first"), nb::arg("shots"), nb::arg("threads"), nb::arg("out"));
    m.def("make_sweep", make_sweep);
    m.def("pocket_ids", pocket_ids);
}

}  // namespace carom::python
