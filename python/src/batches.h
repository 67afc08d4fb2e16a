// Arrays of batches, and the playing of a batch without the GIL.
#pragma once

#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "carom/engine/batch.h"
#include "native.h"

namespace carom::python {

/// The caller's arrays, contiguous, of n and of n x balls (x and y alternate), in the order of Shots in
/// _simulate.py, which makes and checks them: status, duration, events, first_hit, contacts,
/// approach_cushions, xy, pocket, fell, cushions, hash (empty: not wanted).
using ShotArrays = std::tuple<Flat<std::uint8_t>, Flat<double>, Flat<std::int64_t>, Flat<std::int32_t>,
                              Flat<std::int32_t>, Flat<std::int32_t>, Flat<double>, Flat<std::int32_t>,
                              Flat<std::int32_t>, Flat<std::int32_t>, Flat<std::uint64_t>>;

inline BatchArrays batch_arrays(const ShotArrays& arrays) {
    const auto& [status, duration, events, first_hit, contacts, approach_cushions, xy, pocket, fell, cushions,
                 hash] = arrays;
    BatchArrays out;
    out.status = reinterpret_cast<ShotStatus*>(status.data());
    out.duration = duration.data();
    out.events = events.data();
    out.first_hit = first_hit.data();
    out.contacts = contacts.data();
    out.approach_cushions = approach_cushions.data();
    out.x = xy.data();
    out.y = xy.data() + 1;
    out.place_stride = 2;
    out.pocket = pocket.data();
    out.fell = fell.data();
    out.cushions = cushions.data();
    if (hash.size() > 0) out.hash = hash.data();
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
std::vector<Failure> played(const ShotArrays& arrays, std::size_t balls, int threads, Play&& play) {
    const BatchArrays out = batch_arrays(arrays);
    return interruptible([&](std::function<bool()> stop) {
        BatchOptions options;
        options.threads = threads;
        options.stop = std::move(stop);
        std::vector<Failure> failures;
        for (Batch::Message& message : play(options, out)) {
            constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
            out.duration[message.shot] = kNone;
            std::fill_n(out.x + message.shot * balls * 2, 2 * balls, kNone);
            failures.emplace_back(message.shot, std::move(message.text));
        }
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
    return played(out, native.scene->ball.size(), threads,
                  [&](BatchOptions& options, const BatchArrays& into) {
                      Scene scene = *native.scene;
                      scene.stop.events = fewer(scene.stop.events, max_events);
                      options.simulate.until = until;
                      options.absent = left_out;
                      return play(scene, list, isa, options, into);
                  });
}

}  // namespace carom::python
