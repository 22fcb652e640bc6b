// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "io/gltf/document.h"

namespace lanthorn::gltf {

/// Reads the elements of an accessor one by one (glTF 2.0 §3.6.2). Must not outlive the document.
class Accessor {
 public:
  /// The accessor with the index `reference`; checks that it lies inside its buffers. `components`: the required number
  /// of components per element (3 for VEC3). Throws Error.
  Accessor(Document& document, const Value& reference, std::size_t components);

  std::size_t count() const { return count_; }
  /// A component as a float: integers unchanged or, if normalised, mapped to [0, 1] or [-1, 1] (§3.6.2.2). May be
  /// infinite or NaN, which the format forbids.
  float number(std::size_t element, std::size_t component) const;
  /// The same. Throws Error if it is not finite.
  float finite_number(std::size_t element, std::size_t component) const;
  /// A component as an integer, for accessors of unsigned integers.
  std::uint32_t integer(std::size_t element, std::size_t component) const;
  bool is_unsigned() const;

 private:
  enum class Type : std::uint8_t { i8, u8, i16, u16, u32, f32 };
  struct Array {
    std::string_view bytes;
    std::size_t stride = 0;
  };
  struct Sparse {
    std::vector<std::uint32_t> elements;  ///< strictly increasing
    Array values;
  };

  static Type type_of(const Value& value);
  static std::size_t size_of(Type type);
  static Array array(Document& document, const Value& owner, std::size_t count, std::size_t element_size,
                     bool tightly_packed);
  static Sparse sparse(Document& document, const Value& value, std::size_t count, std::size_t element_size);
  const char* component(std::size_t element, std::size_t component) const;

  Value reference_;
  Type type_ = Type::f32;
  bool normalized_ = false;
  std::size_t count_ = 0;
  std::optional<Array> base_;  ///< nullopt: all components are 0
  std::optional<Sparse> sparse_;
};

}  // namespace lanthorn::gltf
