// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Converts Python objects to plain data, and back. numpy arrays go in and out by calls of Python and by
// `__array_interface__`, whose form all versions of numpy share. The C structures of numpy changed with numpy 2:
// nothing here reads them.
#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "lanthorn/plain_data.h"
#include "lanthorn/plain_value.h"

namespace lanthorn::python {

namespace py = pybind11;
using plain::Reader;

/// numpy arrays share their memory with the value.
plain::Value value_of(py::handle object);
/// Arrays share their memory with the object.
py::object object_of(const plain::Value& value);

template <class T>
void read(Reader& reader, py::handle data, T& out) {
  plain::read(reader, value_of(data), out);
}
template <class T>
py::object write(const T& value) {
  return object_of(plain::write(value));
}

/// numpy's text for a type of numbers in this machine's byte order, such as "<f4".
std::string type_text(plain::Scalar type);
template <class Number>
std::string type_text_of() {
  if constexpr (std::is_same_v<Number, bool>)
    return "|b1";
  else
    return type_text(plain::scalar_of<Number>());
}

/// Where an array's numbers lie. Empty strides: the last index runs fastest.
struct ArrayLayout {
  std::string type{};
  std::vector<std::size_t> shape{};
  std::vector<std::ptrdiff_t> strides{};  ///< bytes
};

/// A numpy array that shares memory which `owner` keeps alive.
py::object array_in(const void* memory, const ArrayLayout& layout, const py::object& owner, bool writable);

/// The layout of `values` as an array of numbers: shape (n,), or (n, k) for values of k numbers.
template <class Number, class T>
ArrayLayout layout_of(const std::vector<T>& values) {
  // NOLINTNEXTLINE(bugprone-sizeof-expression): T may be Number
  constexpr std::size_t count = sizeof(T) / sizeof(Number);
  ArrayLayout layout{type_text_of<Number>(), {values.size()}};
  if (count > 1) layout.shape.push_back(count);
  return layout;
}

/// `values` as a writable array, which takes their memory.
template <class Number, class T>
py::object array_of(std::vector<T>&& values) {
  auto* const kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* pointer) { delete static_cast<std::vector<T>*>(pointer); });
  return array_in(kept->data(), layout_of<Number>(*kept), owner, /*writable=*/true);
}

/// Numbers of an object that is an array or that numpy converts to one. Half and long double become double. Numbers
/// that are contiguous and in this machine's byte order share the array's memory. `plain::Other` for other data, such
/// as text.
plain::Value value_of_array(const py::object& object);

}  // namespace lanthorn::python
