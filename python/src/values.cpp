#include "values.h"

#include <nanobind/stl/string.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>

namespace carom::python {
namespace {

using interface::Shape;
using interface::Value;
using Kind = Shape::Kind;

/// The class of a described type. The module carom.games calls this, so it is complete.
nb::handle class_of(const Shape& type) {
    static const auto kClasses = [] {
        std::unordered_map<const Shape*, nb::handle> classes;
        const nb::module_ carom = nb::module_::import_("carom"), games = nb::module_::import_("carom.games");
        for (const Shape* each : interface::types())
            classes[each] =
                nb::object((nb::hasattr(games, each->name) ? games : carom).attr(each->name)).release();
        return classes;
    }();
    return kClasses.at(&type);
}

template <class Item>
nb::object tuple_of(std::size_t count, Item item) {
    const nb::object tuple = nb::steal(PyTuple_New(static_cast<Py_ssize_t>(count)));
    for (std::size_t i = 0; i < count; ++i)
        PyTuple_SetItem(tuple.ptr(), static_cast<Py_ssize_t>(i), nb::object(item(i)).release().ptr());
    return tuple;
}

Value list_from(nb::handle of, const Shape& item) {
    Value list = Value::array();
    try {
        for (const nb::handle each : of) list.push_back(value_from(each, item));
    } catch (const nb::python_error&) {
        return Value::value_t::discarded;
    }
    return list;
}

Value whole_from(nb::handle of) {
    int is_large = 0;
    const long long number = PyLong_AsLongLongAndOverflow(of.ptr(), &is_large);
    return is_large != 0 ? Value(HUGE_VAL) : Value(static_cast<std::int64_t>(number));
}

}  // namespace

nb::object object_of(const Value& value, const Shape& shape) {
    switch (shape.kind) {
        case Kind::kTruth:
            return nb::bool_(value.get<bool>());
        case Kind::kWhole:
            return nb::int_(value.get<std::int64_t>());
        case Kind::kNumber:
            return nb::float_(value.get<double>());
        case Kind::kText:
        case Kind::kChoice: {
            const auto& text = value.get_ref<const std::string&>();
            return nb::str(text.data(), text.size());
        }
        case Kind::kOptional:
            return value.is_null() ? nb::none() : object_of(value, shape.item());
        case Kind::kList: {
            nb::list list;
            for (const Value& each : value) list.append(object_of(each, shape.item()));
            if (interface::shapes::is_numbers(shape))
                return nb::module_::import_("numpy").attr("array")(list);
            return list;
        }
        case Kind::kArray:
            return tuple_of(shape.count, [&](std::size_t i) { return object_of(value[i], shape.item()); });
        case Kind::kType:
            break;
    }
    auto part = value.begin();
    const nb::object members = tuple_of(shape.rows.size(), [&](std::size_t i) {
        const Shape& member = shape.rows[i].shape();
        nb::object object = object_of(*part++, member);
        // A caller's value can be hashed.
        return shape.is_made_by_callers && member.kind == Kind::kList ? nb::object(nb::tuple(object))
                                                                      : object;
    });
    static const nb::handle kNew =
        nb::object(nb::handle(reinterpret_cast<PyObject*>(&PyTuple_Type)).attr("__new__")).release();
    return kNew(class_of(shape), members);
}

Value value_from(nb::handle of, const Shape& shape) {
    if (of.is_none()) return {};
    if (nb::isinstance<nb::bool_>(of)) return nb::cast<bool>(of);
    if (nb::isinstance<nb::int_>(of)) return whole_from(of);
    if (nb::isinstance<nb::float_>(of)) return nb::cast<double>(of);
    if (nb::isinstance<nb::str>(of)) return nb::cast<std::string>(of);
    const Shape& inner = shape.kind == Kind::kOptional ? shape.item() : shape;
    if (inner.kind == Kind::kType) {
        Value all = Value::object();
        if (nb::isinstance<nb::tuple>(of) && nb::len(of) == inner.rows.size()) {
            const nb::tuple members = nb::borrow<nb::tuple>(of);
            for (std::size_t i = 0; i < inner.rows.size(); ++i)
                if (!inner.rows[i].is_computed())
                    all[inner.rows[i].key] = value_from(members[i], inner.rows[i].shape());
            return all;
        }
        return Value::value_t::discarded;
    }
    if (inner.kind == Kind::kList || inner.kind == Kind::kArray) return list_from(of, inner.item());
    // The numbers of numpy.
    if (inner.kind == Kind::kTruth && nb::cast<std::string>(of.type().attr("__name__")).starts_with("bool"))
        return PyObject_IsTrue(of.ptr()) == 1;
    if (PyIndex_Check(of.ptr()) != 0) return whole_from(nb::steal(PyNumber_Index(of.ptr())));
    if (nb::hasattr(of, "__float__")) return nb::cast<double>(nb::steal(PyNumber_Float(of.ptr())));
    return Value::value_t::discarded;
}

}  // namespace carom::python
