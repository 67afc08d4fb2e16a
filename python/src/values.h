// Values of the interface in Python: a described type is the named tuple of its name in carom.games.
#pragma once

#include <nanobind/nanobind.h>

#include "carom/interface/shape.h"

namespace carom::python {

namespace nb = nanobind;

nb::object object_of(const interface::Value& value, const interface::Shape& shape);
/// A value for readers, which refuse the parts that do not fit.
interface::Value value_from(nb::handle of, const interface::Shape& shape);

template <class T>
nb::any given(const T& of) {
    return nb::steal<nb::any>(object_of(interface::value_of(of), interface::shape_of<T>()).release());
}
/// The result of `work`, while other Python threads run.
template <class Work>
auto unlocked(Work&& work) {
    const nb::gil_scoped_release no_gil;
    return work();
}
/// @param name  for messages @throws interface::ValueError
template <class T>
T taken(nb::handle of, const char* name) {
    return interface::read_as<T>(value_from(of, interface::shape_of<T>()), name);
}

}  // namespace carom::python
