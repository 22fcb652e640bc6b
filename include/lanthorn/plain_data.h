// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Converts plain data (dicts, lists, numbers, arrays) to structs, such as those of a scene description, and back.
//
// A struct is a dict with one key per member. `Fields<T>` lists the members once; reading, writing, messages and the
// check for unknown keys are derived from it. A std::variant is a dict whose key "type" names the alternative.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
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

#include "lanthorn/plain_value.h"
#include "lanthorn/scene_description.h"

namespace lanthorn::plain {

using description::Index;

/// The index of each named entry of a table.
using NameTable = std::map<std::string, Index>;

/// State of reading a value and everything in it: tracks the current path for messages, and hashes what it reads.
class Reader {
 public:
  std::map<std::string, std::shared_ptr<const NameTable>> names;  ///< by table ("materials", ...)
  std::uint64_t hash = 0;                                         ///< of all that has been read
  bool is_hashing = true;                                         ///< false: nobody asks for `hash`

  /// The names of a table; empty if it has none.
  const NameTable& names_in(const std::string& table) const;

  void mix(const void* bytes, std::size_t count);
  void mix(std::string_view text) { mix(text.data(), text.size()); }
  /// Calls `read` for a part of the value; `step` extends the path: ".radius", "[2]".
  template <class Read>
  void at(const std::string& step, Read&& read) {
    const std::size_t before = path_.size();
    path_ += step;
    mix(step);
    read();
    path_.resize(before);
  }
  /// Throws Error: "shapes[2].radius: expected a number, got 'wide'".
  [[noreturn]] void fail(const std::string& expected, const Value& got) const;
  [[noreturn]] void fail(const std::string& message) const;

 private:
  std::string path_;
};

template <class T>
struct Fields;

template <class T>
struct Convert;

/// The value as a number; nullopt for everything else, including True and False.
std::optional<double> number_of(const Value& value);

template <class T>
constexpr Scalar scalar_of() {
  constexpr bool is_signed = std::is_signed_v<T>;
  if constexpr (std::is_same_v<T, float>) return Scalar::float32;
  if constexpr (std::is_same_v<T, double>) return Scalar::float64;
  if constexpr (sizeof(T) == 1) return is_signed ? Scalar::int8 : Scalar::uint8;
  if constexpr (sizeof(T) == 2) return is_signed ? Scalar::int16 : Scalar::uint16;
  if constexpr (sizeof(T) == 4) return is_signed ? Scalar::int32 : Scalar::uint32;
  return is_signed ? Scalar::int64 : Scalar::uint64;
}

template <class T>
void read(Reader& reader, const Value& data, T& out) {
  Convert<T>::read(reader, data, out);
}
template <class T>
Value write(const T& value) {
  return Convert<T>::write(value);
}

// Members of structs.

template <class T, class M>
struct Member {
  const char* name;
  M T::*member;
};
/// A member whose key is `name`.
template <class T, class M>
constexpr Member<T, M> field(const char* name, M T::*member) {
  return {name, member};
}
/// An index into a vector of the description or the name of an entry of `table`; or a fixed-size array of these.
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
  static void read(Reader& reader, const Value& data, T& out) {
    if constexpr (std::is_same_v<T, bool>) {
      const bool* flag = data.as<bool>();
      if (flag == nullptr) reader.fail("True or False", data);
      out = *flag;
    } else if constexpr (std::is_integral_v<T>) {
      const auto* whole = data.as<std::int64_t>();
      const auto* large = data.as<std::uint64_t>();
      if (whole == nullptr && large == nullptr) reader.fail("a whole number", data);
      if (whole != nullptr ? !std::in_range<T>(*whole) : !std::in_range<T>(*large))
        reader.fail("a whole number in range", data);
      out = whole != nullptr ? static_cast<T>(*whole) : static_cast<T>(*large);
    } else {
      const std::optional<double> number = number_of(data);
      if (!number || std::isnan(*number)) reader.fail("a number", data);
      out = static_cast<T>(*number);
    }
    reader.mix(&out, sizeof(out));
  }
  static Value write(const T& value) {
    if constexpr (std::is_same_v<T, bool>)
      return value;
    else if constexpr (std::is_floating_point_v<T>)
      return static_cast<double>(value);
    else if constexpr (std::is_signed_v<T>)
      return static_cast<std::int64_t>(value);
    else
      return static_cast<std::uint64_t>(value);
  }
};

template <>
struct Convert<std::string> {
  static void read(Reader& reader, const Value& data, std::string& out) {
    const auto* text = data.as<std::string>();
    if (text == nullptr) reader.fail("text", data);
    out = *text;
    reader.mix(out);
  }
  static Value write(const std::string& text) { return text; }
};

/// The names of an enumeration's values.
template <class E>
struct Names;

template <class E>
requires std::is_enum_v<E>
struct Convert<E> {
  static void read(Reader& reader, const Value& data, E& out) {
    std::string known;
    for (const auto& [name, value] : Names<E>::list) {
      if (data.as<std::string>() != nullptr && *data.as<std::string>() == name) {
        out = value;
        reader.mix(name);
        return;
      }
      known.append(known.empty() ? "'" : ", '").append(name).append("'");
    }
    reader.fail("one of " + known, data);
  }
  static Value write(const E& value) {
    for (const auto& [name, v] : Names<E>::list)
      if (v == value) return std::string(name);
    return {};
  }
};

// Arrays of numbers, or nested lists of numbers.

/// Type and count of the numbers in one element of an array.
template <class T>
struct Numbers;
template <class T>
requires std::is_arithmetic_v<T>
struct Numbers<T> {
  using Scalar = T;
  static constexpr std::size_t count = 1;
};
template <int n, class T, glm::qualifier q>
struct Numbers<glm::vec<n, T, q>> {
  using Scalar = T;
  static constexpr std::size_t count = n;
};
template <class T, std::size_t n>
requires std::is_arithmetic_v<T>
struct Numbers<std::array<T, n>> {
  using Scalar = T;
  static constexpr std::size_t count = n;
};
template <>
struct Numbers<Rgb> {
  using Scalar = float;
  static constexpr std::size_t count = 3;
};
template <class T>
concept NumberElement = requires {
  typename Numbers<T>::Scalar;
};

using Shape = std::vector<std::size_t>;

/// The shape of an array or of nested lists of numbers; a single number has no extents. Fails if `data` is neither, if
/// rows have different lengths, and for fractions where whole numbers are required.
Shape shape_of(Reader& reader, const Value& data, bool is_integral, const std::string& expected);

/// Copies the numbers of an array or of nested lists, whose shape is known, to `out`. Fails for numbers out of range.
template <class T>
void copy_numbers(Reader& reader, const Value& data, T*& out, const std::string& expected) {
  const auto copy = [&](const auto& number) {
    using Number = std::decay_t<decltype(number)>;
    if constexpr (std::is_integral_v<T> && std::is_integral_v<Number>) {
      if (!std::in_range<T>(number)) reader.fail(expected + " in range", plain::write(number));
    }
    *out++ = static_cast<T>(number);  // NOLINT(bugprone-signed-char-misuse): int8 is a number here
  };
  if (const auto* list = data.as<List>()) {
    for (const Value& item : *list) copy_numbers(reader, item, out, expected);
  } else if (const auto* array = data.as<Array>()) {
    with_type(array->type, [&](const auto* type) {
      using Number = std::decay_t<decltype(*type)>;
      if constexpr (std::is_same_v<Number, T>) {
        if (array->count() > 0) std::memcpy(out, array->data, array->count() * sizeof(T));
        out += array->count();
      } else {
        for (std::size_t i = 0; i < array->count(); ++i) {
          Number number{};
          std::memcpy(&number, array->data + i * sizeof(Number), sizeof(Number));
          copy(number);
        }
      }
    });
  } else if (const auto* whole = data.as<std::int64_t>()) {
    copy(*whole);
  } else if (const auto* large = data.as<std::uint64_t>()) {
    copy(*large);
  } else {
    copy(std::get<double>(data));
  }
}

/// Fails for the first of `count` numbers, in rows of `row`, that is infinite or NaN.
template <class T>
void require_finite(const Reader& reader, const T* numbers, std::size_t count, std::size_t row) {
  if constexpr (std::is_floating_point_v<T>) {
    const T* const bad = std::find_if(numbers, numbers + count, [](T x) { return !std::isfinite(x); });
    if (bad != numbers + count)
      reader.fail("expected finite numbers, got " + std::to_string(*bad) + " in entry " +
                  std::to_string(static_cast<std::size_t>(bad - numbers) / row));
  }
}

/// Numbers with their shape, the last index running fastest.
template <class T>
struct NumberArray {
  Shape shape;
  std::vector<T> values;
};
template <class T>
NumberArray<T> number_array(Reader& reader, const Value& data, const std::string& expected) {
  NumberArray<T> array{shape_of(reader, data, std::is_integral_v<T>, expected), {}};
  std::size_t count = 1;
  for (const std::size_t extent : array.shape) count *= extent;
  array.values.resize(count);
  T* out = array.values.data();
  copy_numbers(reader, data, out, expected);
  return array;
}

/// An array that owns `values`.
template <class T>
Array array_of(std::vector<T> values, Shape shape) {
  using Number = typename Numbers<T>::Scalar;
  const auto owner = std::make_shared<const std::vector<T>>(std::move(values));
  return {scalar_of<Number>(), std::move(shape), owner, reinterpret_cast<const std::byte*>(owner->data())};
}

template <NumberElement T>
struct Convert<std::vector<T>> {
  using Number = typename Numbers<T>::Scalar;
  static constexpr std::size_t count = Numbers<T>::count;

  static void read(Reader& reader, const Value& data, std::vector<T>& out) {
    const std::string expected = std::string(std::is_integral_v<Number> ? "whole numbers" : "numbers") +
                                 " of shape (n" + (count > 1 ? ", " + std::to_string(count) + ")" : ")");
    const Shape shape = shape_of(reader, data, std::is_integral_v<Number>, expected);
    const bool is_empty = !shape.empty() && shape[0] == 0;
    const bool fits = is_empty || (count == 1 ? shape.size() == 1 : shape.size() == 2 && shape[1] == count);
    if (!fits) reader.fail(expected, data);
    out.resize(shape[0]);
    auto* numbers = reinterpret_cast<Number*>(out.data());
    if (!is_empty) copy_numbers(reader, data, numbers, expected);
    require_finite(reader, reinterpret_cast<const Number*>(out.data()), out.size() * count, count);
    reader.mix(out.data(), out.size() * sizeof(T));
  }
  static Value write(const std::vector<T>& values) {
    return array_of(values, count > 1 ? Shape{values.size(), count} : Shape{values.size()});
  }
};

/// One element: a colour, a point, ...
template <NumberElement T>
requires(!std::is_arithmetic_v<T>) struct Convert<T> {
  using Number = typename Numbers<T>::Scalar;
  static constexpr std::size_t count = Numbers<T>::count;

  static void read(Reader& reader, const Value& data, T& out) {
    const std::string expected = std::to_string(count) + " numbers";
    if (shape_of(reader, data, std::is_integral_v<Number>, expected) != Shape{count}) reader.fail(expected, data);
    auto* numbers = reinterpret_cast<Number*>(&out);
    copy_numbers(reader, data, numbers, expected);
    require_finite(reader, reinterpret_cast<const Number*>(&out), count, 1);
    reader.mix(&out, sizeof(T));
  }
  static Value write(const T& value) {
    List list;
    for (std::size_t i = 0; i < count; ++i) list.push_back(plain::write(reinterpret_cast<const Number*>(&value)[i]));
    return list;
  }
};

// Containers.

template <class T>
struct Convert<std::optional<T>> {
  static void read(Reader& reader, const Value& data, std::optional<T>& out) {
    if (data.is_none()) return out.reset();
    plain::read(reader, data, out.emplace());
  }
  static Value write(const std::optional<T>& value) { return value ? plain::write(*value) : Value(); }
};

template <class T>
requires(!NumberElement<T>) struct Convert<std::vector<T>> {
  static void read(Reader& reader, const Value& data, std::vector<T>& out) {
    const auto* list = data.as<List>();
    if (list == nullptr) reader.fail("a list", data);
    out.clear();
    for (const Value& item : *list)
      reader.at("[" + std::to_string(out.size()) + "]", [&] { plain::read(reader, item, out.emplace_back()); });
  }
  static Value write(const std::vector<T>& values) {
    List list;
    for (const T& value : values) list.push_back(plain::write(value));
    return list;
  }
};

template <class T>
struct Convert<description::Table<T>> {
  static Value write(const description::Table<T>& table) { return plain::write(table.entries()); }
};

template <class T, std::size_t n>
requires(!std::is_arithmetic_v<T>) struct Convert<std::array<T, n>> {
  static void read(Reader& reader, const Value& data, std::array<T, n>& out) {
    std::vector<T> values;
    plain::read(reader, data, values);
    if (values.size() != n) reader.fail(std::to_string(n) + " values", data);
    std::copy(values.begin(), values.end(), out.begin());
  }
  static Value write(const std::array<T, n>& values) {
    return plain::write(std::vector<T>(values.begin(), values.end()));
  }
};

// Structs and variants.

using Keys = std::vector<std::string>;

/// Reads those members of `out` that `data` has, and adds all valid keys to `known`.
template <Struct T>
void read_members(Reader& reader, const Dict& data, T& out, Keys& known);

/// Names of a variant's alternatives: "'diffuse', 'conductor' ...".
template <class... T>
std::string types_of(const std::variant<T...>*) {
  std::string all;
  ((all.append(all.empty() ? "'" : ", '").append(Fields<T>::type).append("'")), ...);
  return all;
}

/// Reads the alternative that "type" names; without "type", the alternative that `out` holds.
template <class... T>
void read_alternative(Reader& reader, const Dict& data, std::variant<T...>& out, Keys& known) {
  known.emplace_back("type");
  if (const Value* type = data.find("type")) {
    const auto* name = type->as<std::string>();
    bool is_found = false;
    const auto choose = [&]<class A>(std::type_identity<A>) {
      if (is_found || name == nullptr || *name != Fields<A>::type) return;
      is_found = true;
      if (!std::holds_alternative<A>(out)) out.template emplace<A>();
    };
    (choose(std::type_identity<T>()), ...);
    if (!is_found) reader.at(".type", [&] { reader.fail("one of " + types_of(&out), *type); });
    reader.mix(*name);
  }
  std::visit([&](auto& alternative) { read_members(reader, data, alternative, known); }, out);
}

/// Fails if `data` is not a dict.
const Dict& dict_of(Reader& reader, const Value& data);
void refuse_other_keys(Reader& reader, const Dict& data, const Keys& known);
/// Reads an index, or the name of an entry of a table.
void read_reference(Reader& reader, const Value& data, const char* table, Index& out);

template <class T, class M>
void read_member(Reader& reader, const Dict& data, T& out, const Member<T, M>& member, Keys& known) {
  known.emplace_back(member.name);
  if (const Value* value = data.find(member.name))
    reader.at("." + std::string(member.name), [&] { read(reader, *value, out.*member.member); });
}
template <class T, class M>
void read_member(Reader& reader, const Dict& data, T& out, const Reference<T, M>& member, Keys& known) {
  known.emplace_back(member.name);
  const Value* value = data.find(member.name);
  if (value == nullptr) return;
  reader.at("." + std::string(member.name), [&] {
    if constexpr (std::is_same_v<M, std::optional<Index>>) {
      (out.*member.member).reset();
      if (!value->is_none()) read_reference(reader, *value, member.table, (out.*member.member).emplace());
    } else if constexpr (!std::is_same_v<M, Index>) {
      const auto* list = value->as<List>();
      if (list == nullptr || list->size() != (out.*member.member).size())
        reader.fail(std::to_string((out.*member.member).size()) + " indices or names", *value);
      for (std::size_t i = 0; i < list->size(); ++i)
        read_reference(reader, (*list)[i], member.table, (out.*member.member)[i]);
    } else {
      read_reference(reader, *value, member.table, out.*member.member);
    }
  });
}
template <class T, class M>
void read_member(Reader& reader, const Dict& data, T& out, const Node<T, M>& member, Keys& known) {
  read_alternative(reader, data, out.*member.member, known);
}

template <Struct T>
void read_members(Reader& reader, const Dict& data, T& out, Keys& known) {
  std::apply([&](const auto&... member) { (read_member(reader, data, out, member, known), ...); }, Fields<T>::list);
}

template <Struct T>
void write_members(Dict& data, const T& value);

template <class... T>
void write_alternative(Dict& data, const std::variant<T...>& value) {
  std::visit(
      [&]<class A>(const A& alternative) {
        data.set("type", std::string(Fields<A>::type));
        write_members(data, alternative);
      },
      value);
}
template <class T, class M>
void write_member(Dict& data, const T& value, const Member<T, M>& member) {
  data.set(member.name, write(value.*member.member));
}
template <class T, class M>
void write_member(Dict& data, const T& value, const Reference<T, M>& member) {
  data.set(member.name, write(value.*member.member));
}
template <class T, class M>
void write_member(Dict& data, const T& value, const Node<T, M>& member) {
  write_alternative(data, value.*member.member);
}
template <Struct T>
void write_members(Dict& data, const T& value) {
  std::apply([&](const auto&... member) { (write_member(data, value, member), ...); }, Fields<T>::list);
}

template <Struct T>
struct Convert<T> {
  static void read(Reader& reader, const Value& data, T& out) {
    const Dict& dict = dict_of(reader, data);
    Keys known;
    read_members(reader, dict, out, known);
    refuse_other_keys(reader, dict, known);
  }
  static Value write(const T& value) {
    Dict data;
    write_members(data, value);
    return data;
  }
};

template <class... T>
struct Convert<std::variant<T...>> {
  static void read(Reader& reader, const Value& data, std::variant<T...>& out) {
    const Dict& dict = dict_of(reader, data);
    Keys known;
    read_alternative(reader, dict, out, known);
    refuse_other_keys(reader, dict, known);
  }
  static Value write(const std::variant<T...>& value) {
    Dict data;
    write_alternative(data, value);
    return data;
  }
};

// Transforms.

/// A 4 x 4 matrix that multiplies column vectors.
template <>
struct Convert<Transform> {
  static void read(Reader& reader, const Value& data, Transform& out);
  static Value write(const Transform& map);
};
/// A matrix, or a dict of `start`, `end`, `start_time` and `end_time`.
template <>
struct Convert<AnimatedTransform> {
  static void read(Reader& reader, const Value& data, AnimatedTransform& out);
  static Value write(const AnimatedTransform& map);
};
template <>
struct Convert<Mat2> {
  static void read(Reader& reader, const Value& data, Mat2& out);
  static Value write(const Mat2& map);
};

}  // namespace lanthorn::plain
