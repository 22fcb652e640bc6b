// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "plain_data.h"

#include <optional>
#include <vector>

#include "arrays.h"
#include "lanthorn/error.h"

namespace lanthorn::python {

using plain::Array;
using plain::Dict;
using plain::List;
using plain::Value;

namespace {

std::string repr_of(py::handle object) { return py::repr(object).cast<std::string>(); }

Value value_of_whole(const py::object& whole, py::handle object) {
  int overflow = 0;
  const long long number = PyLong_AsLongLongAndOverflow(whole.ptr(), &overflow);
  if (overflow == 0) return static_cast<std::int64_t>(number);
  const unsigned long long large = PyLong_AsUnsignedLongLong(whole.ptr());
  if (!PyErr_Occurred()) return static_cast<std::uint64_t>(large);
  PyErr_Clear();
  return plain::Other{repr_of(object)};
}

Value value_of_dict(const py::dict& data) {
  Dict dict;
  for (const auto& [key, value] : data) {
    if (!py::isinstance<py::str>(key) && !py::isinstance<py::int_>(key))
      throw Error("expected keys that are text, got " + repr_of(key));
    dict.set(py::str(key).cast<std::string>(), value_of(value));
  }
  return dict;
}

// A number, or anything that numpy can convert to an array.
Value value_of_other(py::handle object) {
  const bool is_extended = py::hasattr(object, "ndim") && object.attr("ndim").cast<int>() > 0;
  if (!is_extended && !py::isinstance<py::bool_>(object)) {
    if (PyIndex_Check(object.ptr()) != 0) {
      const auto whole = py::reinterpret_steal<py::object>(PyNumber_Index(object.ptr()));
      if (whole) return value_of_whole(whole, object);
      PyErr_Clear();
    }
    const double number = PyFloat_AsDouble(object.ptr());
    if (!PyErr_Occurred()) return number;
    PyErr_Clear();
  }
  const bool has_array = py::hasattr(object, "__array__") || py::hasattr(object, "__array_interface__") ||
                         PyObject_CheckBuffer(object.ptr()) != 0;
  if (!has_array) return plain::Other{repr_of(object)};
  try {
    return value_of_array(py::reinterpret_borrow<py::object>(object));
  } catch (const py::error_already_set&) {  // numpy cannot convert it
    return plain::Other{repr_of(object)};
  }
}

}  // namespace

Value value_of(py::handle object) {
  if (object.is_none()) return {};
  if (py::isinstance<py::bool_>(object)) return object.cast<bool>();
  if (py::isinstance<py::str>(object)) return object.cast<std::string>();
  if (py::isinstance<py::dict>(object)) return value_of_dict(py::reinterpret_borrow<py::dict>(object));
  if (py::isinstance<py::list>(object) || py::isinstance<py::tuple>(object)) {
    List list;
    for (const py::handle& item : py::reinterpret_borrow<py::sequence>(object)) list.push_back(value_of(item));
    return list;
  }
  return value_of_other(object);
}

py::object object_of(const Value& value) {
  if (const auto* flag = value.as<bool>()) return py::bool_(*flag);
  if (const auto* whole = value.as<std::int64_t>()) return py::int_(*whole);
  if (const auto* large = value.as<std::uint64_t>()) return py::int_(*large);
  if (const auto* number = value.as<double>()) return py::float_(*number);
  if (const auto* text = value.as<std::string>()) return py::str(*text);
  if (const auto* list = value.as<List>()) {
    py::list items;
    for (const Value& item : *list) items.append(object_of(item));
    return items;
  }
  if (const auto* dict = value.as<Dict>()) {
    py::dict data;
    for (const auto& [key, item] : dict->entries()) data[py::str(key)] = object_of(item);
    return data;
  }
  const auto* array = value.as<Array>();
  if (array == nullptr) return py::none();
  auto* owner = new std::shared_ptr<const void>(array->owner);
  const py::capsule capsule(owner, [](void* kept) { delete static_cast<std::shared_ptr<const void>*>(kept); });
  return array_in(array->data, {type_text(array->type), array->shape}, capsule, /*writable=*/true);
}

}  // namespace lanthorn::python
