// The extension module carom._carom: errors, signals, and all its parts.
#include <nanobind/stl/string.h>

#include <chrono>
#include <exception>
#include <string>
#include <thread>

#include "native.h"

namespace carom::python {
namespace {

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// [s] Between two checks for signals: short for a person, and long compared with taking the GIL.
constexpr double kSignalPeriod = 0.05;

void translate(const std::exception_ptr& error, void*) {
    try {
        std::rethrow_exception(error);
    } catch (const SceneError& wrong) {
        const nb::object type = nb::module_::import_("carom._errors").attr("SceneError");
        const SourceLocation at = wrong.where();
        const nb::object value = type(wrong.message(), wrong.file(), at.line, at.column);
        PyErr_SetObject(type.ptr(), value.ptr());
    }
}

}  // namespace

kernel::Isa chosen_isa() {
    const auto [isa, problem] = kernel::isa_from_environment();
    if (*problem != '\0') throw nb::value_error(problem);
    return isa;
}

SignalWatch::SignalWatch() : caller_(std::this_thread::get_id()), next_(seconds_now() + kSignalPeriod) {}

bool SignalWatch::stopped() {
    if (std::this_thread::get_id() != caller_) return false;
    if (raised_) return true;
    const double now = seconds_now();
    if (now < next_) return false;
    next_ = now + kSignalPeriod;
    const nb::gil_scoped_acquire gil;
    raised_ = PyErr_CheckSignals() != 0;
    return raised_;
}

}  // namespace carom::python

NB_MODULE(_carom, m) {
    using namespace carom::python;
    m.doc() = "carom's engine, for the package's own sources; use the package instead.";
    m.attr("VERSION") = CAROM_VERSION;
    nb::register_exception_translator(translate);
    add_scenes(m);
    add_records(m);
    add_shots(m);
    add_batches(m);
    add_measures(m);
    add_impacts(m);
    add_frames(m);
    add_games(m);
    add_arrays(m);
    add_judged(m);
    add_games_rules(m);
    add_derivatives(m);
}
