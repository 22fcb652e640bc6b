// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "lanthorn/error.h"
#include "math/vec.h"

namespace lanthorn::gltf {

/// A value of a JSON file together with its location. A getter that finds a value of another type throws an Error at
/// FILE#POINTER, where POINTER is a JSON pointer (RFC 6901, §6). Refers to the parsed file and its name.
class Value {
 public:
  Value(const nlohmann::json& value, std::string pointer, const std::string& file)
      : json_(&value), file_(&file), pointer_(std::move(pointer)) {}

  bool is_object() const { return json_->is_object(); }
  const std::string& pointer() const { return pointer_; }
  SourceLocation location() const { return {*file_ + "#" + pointer_}; }
  /// Makes an error located at this value.
  Error error(std::string message) const { return {location(), std::move(message)}; }

  /// The member `key` of this object; nullopt if it is missing.
  std::optional<Value> find(std::string_view key) const;
  /// As `find`, but a missing member is an error.
  Value at(std::string_view key) const;
  /// The member `key`, an array of any length; nullopt if it is missing.
  std::optional<Value> find_array(std::string_view key) const;
  /// Number of elements; an error unless this is an array.
  std::size_t size() const;
  /// Element of this array; `i` must be in range.
  Value element(std::size_t i) const;
  /// The member `name` of the member "extensions".
  std::optional<Value> extension(std::string_view name) const;

  float number() const;  ///< finite
  bool boolean() const;
  const std::string& text() const;
  /// A non-negative whole number, at most `largest`.
  std::uint64_t integer(std::uint64_t largest = std::numeric_limits<std::int64_t>::max()) const;
  /// An array of exactly `count` numbers.
  std::vector<float> numbers(std::size_t count) const;

  // Members with a default value.
  float number(std::string_view key, float otherwise) const;
  bool boolean(std::string_view key, bool otherwise) const;
  std::string text(std::string_view key, const std::string& otherwise) const;
  std::uint64_t integer(std::string_view key, std::uint64_t otherwise) const;
  Vec3 vec3(std::string_view key, const Vec3& otherwise) const;

 private:
  const nlohmann::json* json_;
  const std::string* file_;
  std::string pointer_;
};

}  // namespace lanthorn::gltf
