// Arrays of batches, and the playing of a batch without the GIL.
#pragma once

#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/batch.h"
#include "native.h"

namespace carom::python {

/// The caller's contiguous arrays in the order of kOutcomeColumns, which _simulate.py makes and checks; None
/// for one that is not wanted.
using ShotArrays = std::vector<nb::object>;

inline BatchArrays batch_arrays(const ShotArrays& arrays) {
    if (arrays.size() != std::size(kOutcomeColumns))
        throw nb::value_error("expected an array for each column");
    BatchArrays out;
    for (std::size_t i = 0; i < arrays.size(); ++i)
        if (!arrays[i].is_none())
            kOutcomeColumns[i].set_array(out, nb::cast<nb::ndarray<nb::c_contig>>(arrays[i], false).data());
    return out;
}

using Column = std::pair<std::string, Flat<const double>>;
/// A shot without a result, and the reason.
using Failure = std::pair<std::size_t, std::string>;

/// Runs without the GIL. Ctrl-C ends it if `run` calls its argument to check whether to stop.
template <class Run>
auto interruptible(Run&& run) {
    SignalWatch watch;
    try {
        const nb::gil_scoped_release no_gil;
        return run([&watch] { return watch.stopped(); });
    } catch (const BatchStopped&) {
        if (PyErr_Occurred() == nullptr) throw;
        throw nb::python_error();
    } catch (const std::invalid_argument& error) {
        throw nb::value_error(error.what());
    }
}

/// Plays a batch into the caller's arrays.
template <class Play>
std::vector<Failure> played(const ShotArrays& arrays, int threads, Play&& play) {
    const BatchArrays out = batch_arrays(arrays);
    return interruptible([&](std::function<bool()> stop) {
        BatchOptions options;
        options.threads = threads;
        options.stop = std::move(stop);
        std::vector<Failure> failures;
        for (Batch::Message& message : play(options, out))
            failures.emplace_back(message.shot, std::move(message.text));
        return failures;
    });
}

/// As above for shots that differ in the numbers of columns. @param play gets the scene, the columns, the
/// instruction set, options and arrays
template <class Play>
std::vector<Failure> played_columns(const NativeScene& native, const std::vector<Column>& columns,
                                    const Flat<const std::uint8_t>& absent, std::optional<double> until,
                                    std::optional<std::int64_t> max_events, int threads,
                                    const ShotArrays& out, Play&& play) {
    const kernel::Isa isa = chosen_isa();
    std::vector<BatchColumn> list;
    for (const auto& [key, values] : columns) list.push_back({key, std::span(values.data(), values.size())});
    const std::span left_out(absent.data(), absent.size());
    return played(out, threads, [&](BatchOptions& options, const BatchArrays& into) {
        Scene scene = *native.scene;
        scene.stop.events = fewer(scene.stop.events, max_events);
        options.simulate.until = until;
        options.absent = left_out;
        return play(scene, list, isa, options, into);
    });
}

}  // namespace carom::python
