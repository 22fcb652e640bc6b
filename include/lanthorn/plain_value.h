// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Plain data as in Python and JSON: numbers, text, lists, dicts, and arrays of numbers whose memory others own. Scene
// descriptions are read from it and written to it (lanthorn/description_data.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace lanthorn::plain {

enum class Scalar : std::uint8_t { int8, int16, int32, int64, uint8, uint16, uint32, uint64, float32, float64 };

/// Calls `visit` with a null pointer to the C++ type of a scalar, and returns its result.
template <class Visit>
decltype(auto) with_type(Scalar scalar, Visit&& visit) {
  switch (scalar) {
    case Scalar::int8:
      return visit(static_cast<const std::int8_t*>(nullptr));
    case Scalar::int16:
      return visit(static_cast<const std::int16_t*>(nullptr));
    case Scalar::int32:
      return visit(static_cast<const std::int32_t*>(nullptr));
    case Scalar::int64:
      return visit(static_cast<const std::int64_t*>(nullptr));
    case Scalar::uint8:
      return visit(static_cast<const std::uint8_t*>(nullptr));
    case Scalar::uint16:
      return visit(static_cast<const std::uint16_t*>(nullptr));
    case Scalar::uint32:
      return visit(static_cast<const std::uint32_t*>(nullptr));
    case Scalar::uint64:
      return visit(static_cast<const std::uint64_t*>(nullptr));
    case Scalar::float32:
      return visit(static_cast<const float*>(nullptr));
    case Scalar::float64:
      break;
  }
  return visit(static_cast<const double*>(nullptr));
}
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
inline bool is_integer(Scalar scalar) { return scalar < Scalar::float32; }
inline std::size_t bytes_of(Scalar scalar) {
  return with_type(scalar, [](const auto* type) { return sizeof(*type); });
}

/// Numbers in memory that `owner` keeps alive, the last index running fastest; the address need not be aligned.
struct Array {
  Scalar type = Scalar::float32;
  std::vector<std::size_t> shape{};
  std::shared_ptr<const void> owner{};
  const std::byte* data = nullptr;

  std::size_t count() const {
    std::size_t n = 1;
    for (const std::size_t extent : shape) n *= extent;
    return n;
  }
};

/// A value without counterpart in plain data; keeps only its text for messages.
struct Other {
  std::string shown;
};

struct Value;
using List = std::vector<Value>;

/// Named values in insertion order.
class Dict {
 public:
  using Entry = std::pair<std::string, Value>;

  const Value* find(std::string_view name) const;
  bool contains(std::string_view name) const { return find(name) != nullptr; }
  void set(std::string name, Value value);
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  std::vector<Entry> entries_;
};

struct Value
    : std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string, Array, List, Dict, Other> {
  using variant::variant;

  bool is_none() const { return std::holds_alternative<std::monostate>(*this); }
  template <class T>
  const T* as() const {
    return std::get_if<T>(this);
  }
};

/// Abbreviated Python representation: 'text', 1.5, None, [1, 2], {...}.
std::string shown(const Value& value);

}  // namespace lanthorn::plain
