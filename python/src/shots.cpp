// One shot.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/simulate.h"
#include "carom/engine/verify.h"
#include "native.h"

namespace carom::python {
namespace {

/// Ends a run because Python has an exception set.
struct Stopped {};

/// For a run that cannot continue: the record so far, if there is one, becomes part of the exception.
[[noreturn]] void raise_simulation_error(const std::string& why, const nb::object& record) {
    const nb::object error = nb::module_::import_("carom._simulate").attr("simulation_error")(why, record);
    PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
    throw nb::python_error();
}

using RecordObject = nb::typed<nb::object, NativeRecord>;

RecordObject held(std::shared_ptr<const Record> record, const std::shared_ptr<const Scene>& scene) {
    return nb::borrow<RecordObject>(nb::cast(NativeRecord{std::move(record), scene}));
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
    std::shared_ptr<const Record> record;
    std::string why;
    std::vector<std::string> warnings;
    try {
        const nb::gil_scoped_release no_gil;
        Plan plan = make_plan(*native.scene, isa);
        plan.scene.stop.events = fewer(plan.scene.stop.events, max_events);
        warnings = plan.warnings;
        record = std::make_shared<const Record>(simulate(plan, options));
        if (const auto violation = check ? verify(*record, plan) : std::nullopt)
            why = describe(*violation, *record);
    } catch (const Stopped&) {
        throw nb::python_error();
    } catch (const SimulationError& error) {
        why = error.what();
        record = error.so_far();
    }
    for (const std::string& warning : warnings)
        if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 3) != 0) throw nb::python_error();
    if (!why.empty())
        raise_simulation_error(why, record ? nb::object(held(record, native.scene)) : nb::none());
    return held(std::move(record), native.scene);
}

}  // namespace

std::optional<std::int64_t> fewer(std::optional<std::int64_t> a, std::optional<std::int64_t> b) {
    return a && b ? std::min(*a, *b) : (a ? a : b);
}

void add_shots(nb::module_& m) {
    m.def("simulate", simulate_one, nb::arg("scene"), nb::arg("until").none(), nb::arg("max_events").none(),
          nb::arg("verify"));
}

}  // namespace carom::python
