// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Makes the `Type` of a C++ type. Nothing here reads or writes: a type costs the compiler a few small functions.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "lanthorn/render_options.h"
#include "lanthorn/table.h"
#include "plain/special.h"
#include "plain/type.h"

namespace lanthorn::plain {

template <class T>
struct TypeOf {
  static const Type value;
};

/// The names of an enumeration's values, from 0 on.
template <class E>
inline constexpr auto value_names = nullptr;
template <class... Words>
constexpr std::array<std::string_view, sizeof...(Words)> words(Words... all) {
  return {all...};
}

/// The members of a struct.
template <class T>
inline constexpr auto members_of = nullptr;
template <std::size_t n>
struct Members {
  const char* type;
  std::array<Member, n> list;
};
/// A struct that is an alternative of a variant, under the name `type`.
template <class... M>
constexpr Members<sizeof...(M)> alternative(const char* type, M... members) {
  return {type, {members...}};
}
template <class... M>
constexpr Members<sizeof...(M)> structure(M... members) {
  return {nullptr, {members...}};
}

template <class Pointer>
struct Pointed;
template <class T, class M>
struct Pointed<M T::*> {
  using Owner = T;
  using Part = M;
};
/// A member whose key is `name`.
template <auto member>
constexpr Member field(const char* name) {
  using Of = Pointed<decltype(member)>;
  const auto of = [](void* owner) -> void* { return &(static_cast<typename Of::Owner*>(owner)->*member); };
  return {name, &TypeOf<typename Of::Part>::value, of};
}
/// An index into a vector of the description or the name of an entry of `table`; or a fixed-size array of these.
template <auto member>
constexpr Member reference(const char* name, const char* table) {
  Member reference = field<member>(name);
  reference.table = table;
  return reference;
}
/// A member whose keys are keys of the same dict: those of a struct, or "type" and those of a variant's alternative.
template <auto member>
constexpr Member inlined() {
  return field<member>(nullptr);
}

/// The numbers of a value that consists of numbers alone, such as a point: their type and how many there are.
template <class T>
struct Numbers;
template <class T>
requires std::is_arithmetic_v<T>
struct Numbers<T> {
  using Number = T;
  static constexpr std::size_t count = 1;
};
template <int n, class T, glm::qualifier q>
struct Numbers<glm::vec<n, T, q>> {
  using Number = T;
  static constexpr std::size_t count = n;
};
template <class T, std::size_t n>
requires std::is_arithmetic_v<T>
struct Numbers<std::array<T, n>> {
  using Number = T;
  static constexpr std::size_t count = n;
};
template <>
struct Numbers<Rgb> {
  using Number = float;
  static constexpr std::size_t count = 3;
};
template <>
struct Numbers<PassRange> {
  using Number = std::uint64_t;
  static constexpr std::size_t count = 2;
};
template <class T>
concept Row = requires {
  typename Numbers<T>::Number;
};

template <class T>
concept Special = requires(Reader& reader, const Value& data, T& out) {
  read_special(reader, data, out);
};

namespace describe_detail {

template <class T>
inline constexpr const Type* item_types[] = {&TypeOf<T>::value};
template <class... T>
inline constexpr const Type* alternative_types[] = {&TypeOf<T>::value...};

template <Row T>
constexpr Type numbers(Kind kind) {
  return {.kind = kind, .scalar = scalar_of<typename Numbers<T>::Number>(), .count = Numbers<T>::count};
}

template <class T>
constexpr Type describe(std::type_identity<T>) {
  if constexpr (std::is_same_v<T, bool>)
    return {.kind = Kind::flag};
  else if constexpr (std::is_arithmetic_v<T>)
    return numbers<T>(Kind::number);
  else if constexpr (Row<T>)
    return numbers<T>(Kind::row);
  else if constexpr (std::is_same_v<T, std::string>)
    return {.kind = Kind::text};
  else if constexpr (std::is_enum_v<T> && sizeof(T) == 1)
    return {.kind = Kind::choice, .names = value_names<T>};
  else
    return {.kind = Kind::structure, .name = members_of<T>.type, .members = members_of<T>.list};
}

template <class T>
constexpr Type describe(std::type_identity<std::optional<T>>) {
  using Optional = std::optional<T>;
  Type type{.kind = Kind::optional, .items = item_types<T>};
  type.size = [](const void* value) -> std::size_t { return static_cast<const Optional*>(value)->has_value() ? 1 : 0; };
  type.resize = [](void* value, std::size_t size) {
    static_cast<Optional*>(value)->reset();
    if (size > 0) static_cast<Optional*>(value)->emplace();
  };
  type.item = [](void* value, std::size_t) -> void* { return &**static_cast<Optional*>(value); };
  return type;
}

template <class T>
constexpr Type describe(std::type_identity<std::vector<T>>) {
  using Vector = std::vector<T>;
  Type type{.kind = Kind::list, .items = item_types<T>};
  if constexpr (Row<T>) type = numbers<T>(Kind::rows);
  type.size = [](const void* value) { return static_cast<const Vector*>(value)->size(); };
  type.resize = [](void* value, std::size_t size) { *static_cast<Vector*>(value) = Vector(size); };
  type.item = [](void* value, std::size_t i) -> void* { return static_cast<Vector*>(value)->data() + i; };
  return type;
}

// Looks at the table as a constant, because other access counts as a change. Only items that `resize` made may change.
template <class T>
constexpr Type describe(std::type_identity<description::Table<T>>) {
  using Table = description::Table<T>;
  Type type{.kind = Kind::list, .items = item_types<T>};
  type.size = [](const void* value) { return static_cast<const Table*>(value)->size(); };
  type.resize = [](void* value, std::size_t size) { *static_cast<Table*>(value) = std::vector<T>(size); };
  type.item = [](void* value, std::size_t i) -> void* {
    return const_cast<T*>(&static_cast<const Table*>(value)->entries()[i]);
  };
  return type;
}

template <Row T, std::size_t n>
requires(!std::is_arithmetic_v<T>) constexpr Type describe(std::type_identity<std::array<T, n>>) {
  Type type = numbers<T>(Kind::rows);
  type.size = [](const void*) { return n; };
  type.item = [](void* value, std::size_t) -> void* { return value; };
  return type;
}

template <class... T>
constexpr Type describe(std::type_identity<std::variant<T...>>) {
  using Variant = std::variant<T...>;
  Type type{.kind = Kind::variant, .items = alternative_types<T...>};
  type.size = [](const void* value) { return static_cast<const Variant*>(value)->index(); };
  type.resize = [](void* value, std::size_t index) {
    std::size_t i = 0;
    ((i++ == index ? static_cast<void>(static_cast<Variant*>(value)->template emplace<T>()) : void()), ...);
  };
  type.item = [](void* value, std::size_t) -> void* {
    return std::visit([](auto& held) -> void* { return &held; }, *static_cast<Variant*>(value));
  };
  return type;
}

template <Special T>
constexpr Type special() {
  Type type{.kind = Kind::special};
  type.read = [](Reader& reader, const Value& data, void* out) { read_special(reader, data, *static_cast<T*>(out)); };
  type.write = [](const void* value) { return write_special(*static_cast<const T*>(value)); };
  return type;
}

}  // namespace describe_detail

template <class T>
constexpr Type TypeOf<T>::value = [] {
  Type type;
  if constexpr (Special<T>)
    type = describe_detail::special<T>();
  else
    type = describe_detail::describe(std::type_identity<T>());
  type.assign = [](void* value, const void* other) { *static_cast<T*>(value) = *static_cast<const T*>(other); };
  return type;
}();

}  // namespace lanthorn::plain
