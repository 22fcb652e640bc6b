// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Converts Python objects to plain data, and back.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <utility>

#include "lanthorn/plain_data.h"

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

}  // namespace lanthorn::python
