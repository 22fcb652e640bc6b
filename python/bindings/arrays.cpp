// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

namespace lanthorn::python {

using plain::Scalar;

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

}  // namespace lanthorn::python
