// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "plain_data.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "lanthorn/error.h"

namespace lanthorn::python {

using plain::Array;
using plain::Dict;
using plain::List;
using plain::Scalar;
using plain::Value;

namespace {

constexpr std::array<std::pair<std::string_view, Scalar>, 10> types{{{"i1", Scalar::int8},
                                                                     {"i2", Scalar::int16},
                                                                     {"i4", Scalar::int32},
                                                                     {"i8", Scalar::int64},
                                                                     {"u1", Scalar::uint8},
                                                                     {"u2", Scalar::uint16},
                                                                     {"u4", Scalar::uint32},
                                                                     {"u8", Scalar::uint64},
                                                                     {"f4", Scalar::float32},
                                                                     {"f8", Scalar::float64}}};
constexpr char own_byte_order = std::endian::native == std::endian::little ? '<' : '>';

// nullopt for another byte order and for types that are not listed.
std::optional<Scalar> scalar_of(std::string_view text) {
  if (text.empty() || (text[0] != own_byte_order && text[0] != '|')) return std::nullopt;
  for (const auto& [name, scalar] : types)
    if (text.substr(1) == name) return scalar;
  return std::nullopt;
}

// Numbers by numpy's definition: whole numbers and floating-point numbers of any size and byte order.
bool is_number(std::string_view text) {
  return text.size() > 1 && std::string_view("iuf").find(text[1]) != std::string_view::npos;
}

template <class... Arguments>
py::object contiguous(const py::object& object, Arguments&&... arguments) {
  using namespace py::literals;
  return py::module_::import("numpy").attr("asarray")(object, "order"_a = "C", std::forward<Arguments>(arguments)...);
}

std::string type_of(const py::object& array) {
  return array.attr("__array_interface__")["typestr"].cast<std::string>();
}

// Keeps a Python object alive. The last reference may be dropped on a thread that runs no Python code.
std::shared_ptr<const void> keeper_of(const py::object& object) {
  return {object.ptr(), [kept = object](const void*) mutable {
            const py::gil_scoped_acquire acquire;
            kept = py::object();
          }};
}

template <class T>
py::tuple tuple_of(const std::vector<T>& values) {
  py::tuple tuple(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) tuple[i] = py::int_(values[i]);
  return tuple;
}

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

std::string type_text(Scalar type) {
  const auto* const found = std::find_if(types.begin(), types.end(), [&](const auto& t) { return t.second == type; });
  return own_byte_order + std::string(found->first);
}

py::object array_in(const void* memory, const ArrayLayout& layout, const py::object& owner, bool writable) {
  static const char nothing = 0;  // where an empty vector's memory would be: a null pointer would ask numpy for memory
  const void* const address = memory != nullptr ? memory : &nothing;
  py::dict interface;
  interface["version"] = 3;
  interface["typestr"] = layout.type;
  interface["shape"] = tuple_of(layout.shape);
  if (!layout.strides.empty()) interface["strides"] = tuple_of(layout.strides);
  interface["data"] = py::make_tuple(reinterpret_cast<std::uintptr_t>(address), !writable);
  py::dict members;
  members["__array_interface__"] = interface;
  members["owner"] = owner;
  // The array keeps this object, and with it the owner.
  return py::module_::import("numpy").attr("asarray")(py::module_::import("types").attr("SimpleNamespace")(**members));
}

plain::Value value_of_array(const py::object& object) {
  using namespace py::literals;
  py::object array = contiguous(object);
  if (std::string type = type_of(array); is_number(type) && !scalar_of(type))
    array = contiguous(array, "dtype"_a = "float64");
  const py::dict interface = array.attr("__array_interface__");
  const std::optional<Scalar> scalar = scalar_of(interface["typestr"].cast<std::string>());
  if (!scalar) return plain::Other{py::repr(object).cast<std::string>()};
  const auto address = interface["data"].cast<py::tuple>()[0].cast<std::uintptr_t>();
  plain::Array value{*scalar, {}, keeper_of(array), reinterpret_cast<const std::byte*>(address)};
  for (const py::handle& extent : interface["shape"]) value.shape.push_back(extent.cast<std::size_t>());
  return value;
}

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
