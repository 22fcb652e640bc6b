// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Python's plain data (dicts, lists, numbers, arrays) to the structs of a scene description, and back.
//
// A struct is a dict with one key per member. `Fields<T>` lists the members once; reading, writing, messages and the
// check for unknown keys follow from it. A std::variant is a dict whose key "type" names the alternative.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "lanthorn/scene_description.h"

namespace lanthorn::python {

namespace py = pybind11;
using description::Index;

/// Reads one value and all that it contains. Knows where it is, for messages, and hashes what it has read.
class Reader {
 public:
  /// What a name in the data stands for: an index into the vector `table` ("materials", ...).
  std::map<std::string, std::map<std::string, Index>> names;
  std::uint64_t hash = 0xcbf29ce484222325u;  ///< FNV-1a

  void mix(const void* bytes, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
      hash = (hash ^ static_cast<const unsigned char*>(bytes)[i]) * 0x100000001b3u;
  }
  void mix(std::string_view text) { mix(text.data(), text.size()); }
  /// Calls `read` for a part of the value, whose place is `step` further: ".radius", "[2]".
  template <class Read>
  void at(const std::string& step, Read&& read) {
    const std::size_t before = path_.size();
    path_ += step;
    mix(step);
    read();
    path_.resize(before);
  }
  /// Throws Error: "shapes[2].radius: expected a number, got 'wide'".
  [[noreturn]] void fail(const std::string& expected, py::handle got) const;
  [[noreturn]] void fail(const std::string& message) const;

 private:
  std::string path_;
};

template <class T>
struct Fields;

template <class T>
struct Convert;

template <class T>
void read(Reader& reader, py::handle data, T& out) {
  Convert<T>::read(reader, data, out);
}
template <class T>
py::object write(const T& value) {
  return Convert<T>::write(value);
}

// Members of structs.

template <class T, class M>
struct Member {
  const char* name;
  M T::*member;
};
/// A member of the struct's own name.
template <class T, class M>
constexpr Member<T, M> field(const char* name, M T::*member) {
  return {name, member};
}
/// An index into a vector of the description, or the name of what is there.
template <class T, class M>
struct Reference {
  const char* name;
  const char* table;
  M T::*member;
};
template <class T, class M>
constexpr Reference<T, M> reference(const char* name, const char* table, M T::*member) {
  return {name, table, member};
}
/// A variant whose alternative's members are keys of the same dict, beside "type".
template <class T, class M>
struct Node {
  M T::*member;
};
template <class T, class M>
constexpr Node<T, M> node(M T::*member) {
  return {member};
}

template <class T>
concept Struct = requires {
  Fields<T>::list;
};

// Numbers, text, enumerations.

template <class T>
requires std::is_arithmetic_v<T>
struct Convert<T> {
  static void read(Reader& reader, py::handle data, T& out) {
    if constexpr (std::is_same_v<T, bool>) {
      if (!py::isinstance<py::bool_>(data)) reader.fail("True or False", data);
      out = data.cast<bool>();
    } else if constexpr (std::is_integral_v<T>) {
      const py::object whole = py::reinterpret_steal<py::object>(PyNumber_Index(data.ptr()));
      if (!whole || py::isinstance<py::bool_>(data)) fail(reader, "a whole number", data);
      py::detail::make_caster<T> caster;
      if (!caster.load(whole, true)) fail(reader, "a whole number in range", data);
      out = py::detail::cast_op<T>(caster);
    } else {
      const double number = py::isinstance<py::bool_>(data) ? -1 : PyFloat_AsDouble(data.ptr());
      if (PyErr_Occurred() || py::isinstance<py::bool_>(data)) fail(reader, "a number", data);
      out = static_cast<T>(number);
    }
    reader.mix(&out, sizeof(out));
  }
  static py::object write(const T& value) { return py::cast(value); }

 private:
  [[noreturn]] static void fail(Reader& reader, const char* expected, py::handle data) {
    PyErr_Clear();
    reader.fail(expected, data);
  }
};

template <>
struct Convert<std::string> {
  static void read(Reader& reader, py::handle data, std::string& out) {
    if (!py::isinstance<py::str>(data)) reader.fail("text", data);
    out = data.cast<std::string>();
    reader.mix(out);
  }
  static py::object write(const std::string& text) { return py::str(text); }
};

/// The names of an enumeration's values.
template <class E>
struct Names;

template <class E>
requires std::is_enum_v<E>
struct Convert<E> {
  static void read(Reader& reader, py::handle data, E& out) {
    std::string known;
    for (const auto& [name, value] : Names<E>::list) {
      if (py::isinstance<py::str>(data) && data.cast<std::string>() == name) {
        out = value;
        reader.mix(name);
        return;
      }
      known.append(known.empty() ? "'" : ", '").append(name).append("'");
    }
    reader.fail("one of " + known, data);
  }
  static py::object write(const E& value) {
    for (const auto& [name, v] : Names<E>::list)
      if (v == value) return py::str(std::string(name));
    return py::none();
  }
};

// Arrays of numbers: numpy's, or nested lists.

/// What an element of an array consists of.
template <class T>
struct Numbers;
template <class T>
requires std::is_arithmetic_v<T>
struct Numbers<T> {
  using Scalar = T;
  static constexpr py::ssize_t count = 1;
};
template <int n, class T, glm::qualifier q>
struct Numbers<glm::vec<n, T, q>> {
  using Scalar = T;
  static constexpr py::ssize_t count = n;
};
template <class T, std::size_t n>
requires std::is_arithmetic_v<T>
struct Numbers<std::array<T, n>> {
  using Scalar = T;
  static constexpr py::ssize_t count = n;
};
template <>
struct Numbers<Rgb> {
  using Scalar = float;
  static constexpr py::ssize_t count = 3;
};
template <class T>
concept NumberElement = requires {
  typename Numbers<T>::Scalar;
};

/// The data as a C-contiguous array of the scalar type. Fails for fractions and negative numbers where indices belong.
template <class Scalar>
py::array_t<Scalar> number_array(Reader& reader, py::handle data, const std::string& expected) {
  using Wide = std::conditional_t<std::is_integral_v<Scalar>, std::int64_t, Scalar>;
  const py::array any = py::array::ensure(data);
  if (!any) PyErr_Clear();
  const bool is_number = any && std::string_view("iuf").find(any.dtype().kind()) != std::string_view::npos;
  if (!is_number || (std::is_integral_v<Scalar> && any.dtype().kind() == 'f' && any.size() > 0))
    reader.fail(expected, data);
  const py::array_t<Wide, py::array::c_style | py::array::forcecast> wide(any);
  if constexpr (std::is_integral_v<Scalar>) {
    for (py::ssize_t i = 0; i < wide.size(); ++i)
      if (!std::in_range<Scalar>(wide.data()[i])) reader.fail(expected + " in range", py::int_(wide.data()[i]));
  }
  return py::array_t<Scalar, py::array::c_style | py::array::forcecast>(wide);
}

template <NumberElement T>
struct Convert<std::vector<T>> {
  using Scalar = typename Numbers<T>::Scalar;
  static constexpr py::ssize_t count = Numbers<T>::count;

  static void read(Reader& reader, py::handle data, std::vector<T>& out) {
    const std::string expected = std::string(std::is_integral_v<Scalar> ? "whole numbers" : "numbers") +
                                 " of shape (n" + (count > 1 ? ", " + std::to_string(count) + ")" : ")");
    const py::array_t<Scalar> array = number_array<Scalar>(reader, data, expected);
    const bool fits =
        array.size() == 0 || (count == 1 ? array.ndim() == 1 : array.ndim() == 2 && array.shape(1) == count);
    if (!fits) reader.fail(expected, data);
    out.resize(static_cast<std::size_t>(array.size() / count));
    if (!out.empty()) std::memcpy(static_cast<void*>(out.data()), array.data(), out.size() * sizeof(T));
    reader.mix(out.data(), out.size() * sizeof(T));
  }
  static py::object write(const std::vector<T>& values) {
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(values.size())};
    if (count > 1) shape.push_back(count);
    py::array_t<Scalar> array(shape);
    if (!values.empty()) std::memcpy(array.mutable_data(), values.data(), values.size() * sizeof(T));
    return array;
  }
};

/// One element: a colour, a point, ...
template <NumberElement T>
requires(!std::is_arithmetic_v<T>) struct Convert<T> {
  using Scalar = typename Numbers<T>::Scalar;
  static constexpr py::ssize_t count = Numbers<T>::count;

  static void read(Reader& reader, py::handle data, T& out) {
    const std::string expected = std::to_string(count) + " numbers";
    const py::array_t<Scalar> array = number_array<Scalar>(reader, data, expected);
    if (array.size() != count || array.ndim() != 1) reader.fail(expected, data);
    std::memcpy(static_cast<void*>(&out), array.data(), sizeof(T));
    reader.mix(&out, sizeof(T));
  }
  static py::object write(const T& value) {
    py::list list;
    for (py::ssize_t i = 0; i < count; ++i) list.append(reinterpret_cast<const Scalar*>(&value)[i]);
    return list;
  }
};

// Containers.

template <class T>
struct Convert<std::optional<T>> {
  static void read(Reader& reader, py::handle data, std::optional<T>& out) {
    if (data.is_none()) return out.reset();
    python::read(reader, data, out.emplace());
  }
  static py::object write(const std::optional<T>& value) { return value ? python::write(*value) : py::none(); }
};

template <class T>
requires(!NumberElement<T>) struct Convert<std::vector<T>> {
  static void read(Reader& reader, py::handle data, std::vector<T>& out) {
    if (!py::isinstance<py::list>(data) && !py::isinstance<py::tuple>(data)) reader.fail("a list", data);
    out.clear();
    for (const py::handle& item : data.cast<py::sequence>())
      reader.at("[" + std::to_string(out.size()) + "]", [&] { python::read(reader, item, out.emplace_back()); });
  }
  static py::object write(const std::vector<T>& values) {
    py::list list;
    for (const T& value : values) list.append(python::write(value));
    return list;
  }
};

template <class T, std::size_t n>
requires(!std::is_arithmetic_v<T>) struct Convert<std::array<T, n>> {
  static void read(Reader& reader, py::handle data, std::array<T, n>& out) {
    std::vector<T> values;
    python::read(reader, data, values);
    if (values.size() != n) reader.fail(std::to_string(n) + " values", data);
    std::copy(values.begin(), values.end(), out.begin());
  }
  static py::object write(const std::array<T, n>& values) {
    return python::write(std::vector<T>(values.begin(), values.end()));
  }
};

// Structs and variants.

using Keys = std::vector<std::string>;

/// Reads the members of `out` that `data` has, and adds the keys that it may have to `known`.
template <Struct T>
void read_members(Reader& reader, const py::dict& data, T& out, Keys& known);

/// Names of a variant's alternatives: "'diffuse', 'conductor' ...".
template <class... T>
std::string types_of(const std::variant<T...>*) {
  std::string all;
  ((all.append(all.empty() ? "'" : ", '").append(Fields<T>::type).append("'")), ...);
  return all;
}

/// The alternative that "type" names. Without "type": the one that `out` has.
template <class... T>
void read_alternative(Reader& reader, const py::dict& data, std::variant<T...>& out, Keys& known) {
  known.emplace_back("type");
  if (data.contains("type")) {
    const py::object type = data["type"];
    bool is_found = false;
    const auto choose = [&]<class A>(std::type_identity<A>) {
      if (is_found || !py::isinstance<py::str>(type) || type.cast<std::string>() != Fields<A>::type) return;
      is_found = true;
      if (!std::holds_alternative<A>(out)) out.template emplace<A>();
    };
    (choose(std::type_identity<T>()), ...);
    if (!is_found) reader.at(".type", [&] { reader.fail("one of " + types_of(&out), type); });
    reader.mix(type.cast<std::string>());
  }
  std::visit([&](auto& alternative) { read_members(reader, data, alternative, known); }, out);
}

void require_dict(Reader& reader, py::handle data);
void refuse_other_keys(Reader& reader, const py::dict& data, const Keys& known);
/// An index, or the name of an entry of a table.
void read_reference(Reader& reader, py::handle data, const char* table, Index& out);

template <class T, class M>
void read_member(Reader& reader, const py::dict& data, T& out, const Member<T, M>& member, Keys& known) {
  known.emplace_back(member.name);
  if (!data.contains(member.name)) return;
  reader.at("." + std::string(member.name), [&] { read(reader, data[member.name], out.*member.member); });
}
template <class T, class M>
void read_member(Reader& reader, const py::dict& data, T& out, const Reference<T, M>& member, Keys& known) {
  known.emplace_back(member.name);
  if (!data.contains(member.name)) return;
  const py::object value = data[member.name];
  reader.at("." + std::string(member.name), [&] {
    if constexpr (std::is_same_v<M, std::optional<Index>>) {
      (out.*member.member).reset();
      if (!value.is_none()) read_reference(reader, value, member.table, (out.*member.member).emplace());
    } else {
      read_reference(reader, value, member.table, out.*member.member);
    }
  });
}
template <class T, class M>
void read_member(Reader& reader, const py::dict& data, T& out, const Node<T, M>& member, Keys& known) {
  read_alternative(reader, data, out.*member.member, known);
}

template <Struct T>
void read_members(Reader& reader, const py::dict& data, T& out, Keys& known) {
  std::apply([&](const auto&... member) { (read_member(reader, data, out, member, known), ...); }, Fields<T>::list);
}

template <Struct T>
void write_members(py::dict& data, const T& value);

template <class... T>
void write_alternative(py::dict& data, const std::variant<T...>& value) {
  std::visit(
      [&]<class A>(const A& alternative) {
        data["type"] = Fields<A>::type;
        write_members(data, alternative);
      },
      value);
}
template <class T, class M>
void write_member(py::dict& data, const T& value, const Member<T, M>& member) {
  data[member.name] = write(value.*member.member);
}
template <class T, class M>
void write_member(py::dict& data, const T& value, const Reference<T, M>& member) {
  data[member.name] = write(value.*member.member);
}
template <class T, class M>
void write_member(py::dict& data, const T& value, const Node<T, M>& member) {
  write_alternative(data, value.*member.member);
}
template <Struct T>
void write_members(py::dict& data, const T& value) {
  std::apply([&](const auto&... member) { (write_member(data, value, member), ...); }, Fields<T>::list);
}

template <Struct T>
struct Convert<T> {
  static void read(Reader& reader, py::handle data, T& out) {
    require_dict(reader, data);
    const auto dict = py::reinterpret_borrow<py::dict>(data);
    Keys known;
    read_members(reader, dict, out, known);
    refuse_other_keys(reader, dict, known);
  }
  static py::object write(const T& value) {
    py::dict data;
    write_members(data, value);
    return data;
  }
};

template <class... T>
struct Convert<std::variant<T...>> {
  static void read(Reader& reader, py::handle data, std::variant<T...>& out) {
    require_dict(reader, data);
    const auto dict = py::reinterpret_borrow<py::dict>(data);
    Keys known;
    read_alternative(reader, dict, out, known);
    refuse_other_keys(reader, dict, known);
  }
  static py::object write(const std::variant<T...>& value) {
    py::dict data;
    write_alternative(data, value);
    return data;
  }
};

// Maps.

/// A 4 x 4 matrix that multiplies column vectors.
template <>
struct Convert<Transform> {
  static void read(Reader& reader, py::handle data, Transform& out);
  static py::object write(const Transform& map);
};
/// A matrix, or a dict of `start`, `end`, `start_time` and `end_time`.
template <>
struct Convert<AnimatedTransform> {
  static void read(Reader& reader, py::handle data, AnimatedTransform& out);
  static py::object write(const AnimatedTransform& map);
};
template <>
struct Convert<Mat2> {
  static void read(Reader& reader, py::handle data, Mat2& out);
  static py::object write(const Mat2& map);
};

// Spectra.

/// A number; three numbers, which are R, G, B; or a dict: {"rgb": ..., "space": ...}, {"blackbody": kelvin},
/// {"named": name}, {"nm": ..., "values": ...}.
template <>
struct Convert<description::SpectrumValue> {
  static void read(Reader& reader, py::handle data, description::SpectrumValue& out);
  static py::object write(const description::SpectrumValue& value);
};
/// The value, or {"texture": index or name, "value": ...}.
template <>
struct Convert<description::FloatParameter> {
  static void read(Reader& reader, py::handle data, description::FloatParameter& out);
  static py::object write(const description::FloatParameter& value);
};
template <>
struct Convert<description::SpectrumParameter> {
  static void read(Reader& reader, py::handle data, description::SpectrumParameter& out);
  static py::object write(const description::SpectrumParameter& value);
};

/// An environment's colours as an array (height, width, 3).
template <>
struct Convert<std::shared_ptr<const description::SphericalTexels>> {
  using Texels = std::shared_ptr<const description::SphericalTexels>;
  static void read(Reader& reader, py::handle data, Texels& out);
  static py::object write(const Texels& texels);
};

}  // namespace lanthorn::python
