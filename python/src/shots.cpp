// One shot, and many.
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
#include "carom/engine/plan.h"
#include "carom/engine/simulate.h"
#include "carom/engine/verify.h"
#include "native.h"

namespace carom::python {
namespace {

/// Ends a run because Python has an exception set.
struct Stopped {};

/// Of a run that cannot go on: the record so far, if there is one, becomes part of the exception.
[[noreturn]] void raise_simulation_error(const std::string& why, const nb::object& record) {
    const nb::object error = nb::module_::import_("carom._errors").attr("simulation_error")(why, record);
    PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
    throw nb::python_error();
}

using RecordObject = nb::typed<nb::object, NativeRecord>;

RecordObject held(Record&& record, const std::shared_ptr<const Scene>& scene) {
    return nb::borrow<RecordObject>(nb::cast(NativeRecord{std::move(record), scene}));
}

std::optional<std::int64_t> fewer(std::optional<std::int64_t> a, std::optional<std::int64_t> b) {
    return a && b ? std::min(*a, *b) : (a ? a : b);
}

RecordObject simulate_one(const NativeScene& native, std::optional<double> until,
                          std::optional<std::int64_t> max_events, bool check) {
    const kernel::Isa isa = chosen_isa();
    SignalWatch watch;
    SimulateOptions options;
    options.until = until;
    options.progress = [&watch](std::size_t, double) {
        if (watch.stopped()) throw Stopped();
    };
    std::shared_ptr<const Record> so_far;
    std::string why;
    Record record;
    std::vector<std::string> warnings;
    try {
        const nb::gil_scoped_release no_gil;
        Plan plan = make_plan(*native.scene, isa);
        plan.scene.stop.events = fewer(plan.scene.stop.events, max_events);
        warnings = plan.warnings;
        record = simulate(plan, options);
        if (const auto violation = check ? verify(record, plan) : std::nullopt) {
            why = violation->law + " broken at event " + std::to_string(violation->event) + ": " +
                  violation->message;
            so_far = std::make_shared<const Record>(std::move(record));
        }
    } catch (const Stopped&) {
        throw nb::python_error();
    } catch (const SimulationError& error) {
        why = error.what();
        so_far = error.so_far();
    }
    for (const std::string& warning : warnings)
        if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 2) != 0) throw nb::python_error();
    if (!why.empty())
        raise_simulation_error(why, so_far ? nb::object(held(Record(*so_far), native.scene)) : nb::none());
    return held(std::move(record), native.scene);
}

/// Arrays of the caller's, shaped by simulate_many in Python: contiguous, of n and of n x balls (x and y alternate).
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

/// A shot without a result has no numbers.
void clear_failures(const BatchArrays& out, const std::vector<Batch::Message>& failures, std::size_t balls) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    for (const Batch::Message& failure : failures) {
        out.duration[failure.shot] = kNone;
        std::fill_n(out.x + failure.shot * balls * 2, 2 * balls, kNone);
    }
}

using Column = std::pair<std::string, Flat<const double>>;

std::vector<std::pair<std::size_t, std::string>> many(
    const NativeScene& native, std::size_t shots, const std::vector<Column>& columns,
    std::optional<double> until, std::optional<std::int64_t> max_events, int threads,
    Flat<std::uint8_t> status, Flat<double> duration, Flat<std::int64_t> events, Flat<std::int32_t> first_hit,
    Flat<double> xy, Flat<std::int32_t> pocket, Flat<std::int32_t> fell, Flat<std::int32_t> cushions,
    Flat<std::uint64_t> hash) {
    const kernel::Isa isa = chosen_isa();
    const BatchArrays out = ShotArrays{std::move(status),    std::move(duration), std::move(events),
                                       std::move(first_hit), std::move(xy),       std::move(pocket),
                                       std::move(fell),      std::move(cushions), std::move(hash)}
                                .arrays();
    std::vector<BatchColumn> list;
    for (const auto& [key, values] : columns) list.push_back({key, std::span(values.data(), values.size())});
    SignalWatch watch;
    BatchOptions options;
    options.threads = threads;
    options.simulate.until = until;
    options.stop = [&watch] { return watch.stopped(); };
    std::vector<Batch::Message> failures;
    try {
        const nb::gil_scoped_release no_gil;
        Scene scene = *native.scene;
        scene.stop.events = fewer(scene.stop.events, max_events);
        failures = simulate_many(scene, shots, list, isa, options, out);
        clear_failures(out, failures, scene.ball.size());
    } catch (const BatchStopped&) {
        throw nb::python_error();
    } catch (const std::invalid_argument& error) {
        throw nb::value_error(error.what());
    }
    std::vector<std::pair<std::size_t, std::string>> messages;
    for (Batch::Message& failure : failures) messages.emplace_back(failure.shot, std::move(failure.text));
    return messages;
}

}  // namespace

void add_shots(nb::module_& m) {
    m.def("simulate", simulate_one, nb::arg("scene"), nb::arg("until").none(), nb::arg("max_events").none(),
          nb::arg("verify"));
    m.def("simulate_many", many, nb::arg("scene"), nb::arg("shots"), nb::arg("columns"),
          nb::arg("until").none(), nb::arg("max_events").none(), nb::arg("threads"),
          nb::arg("status").noconvert(), nb::arg("duration").noconvert(), nb::arg("events").noconvert(),
          nb::arg("first_hit").noconvert(), nb::arg("xy").noconvert(), nb::arg("pocket").noconvert(),
          nb::arg("fell").noconvert(), nb::arg("cushions").noconvert(), nb::arg("hash").noconvert());
}

}  // namespace carom::python
