// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lanthorn/error.h"
#include "math/vec.h"

namespace lanthorn::gltf {

class Value;

/// The file that values come from.
struct Source {
  std::string name;
  /// Called for a value that is wrong and has been replaced. The message says what is used instead. Values that share
  /// `key` have the same kind of problem.
  std::function<void(const Value& place, const std::string& key, const std::string& message)> warn;
};

/// The numbers that a property may have.
struct Range {
  float least = -std::numeric_limits<float>::infinity(), most = std::numeric_limits<float>::infinity();
  bool has_least = true, has_most = true;  ///< the limits themselves are valid

  static constexpr Range at_least(float limit) { return {limit}; }
  static constexpr Range above(float limit) { return {limit, std::numeric_limits<float>::infinity(), false}; }
  bool contains(float x) const {
    return (x > least || (has_least && x == least)) && (x < most || (has_most && x == most));
  }
};
inline constexpr Range zero_to_one{0, 1};

/// A value of a JSON file together with its location. A getter that finds a value of another type throws an Error at
/// FILE#POINTER, where POINTER is a JSON pointer (RFC 6901, §6). Refers to the parsed file and its source.
///
/// A wrong number in one property must not lose the whole file, which other programs read: getters with a default
/// warn instead, and return the valid limit or else the default. A member that is null counts as missing.
class Value {
 public:
  Value(const nlohmann::json& value, std::string pointer, const Source& source)
      : json_(&value), source_(&source), pointer_(std::move(pointer)) {}

  bool is_object() const { return json_->is_object(); }
  const std::string& pointer() const { return pointer_; }
  SourceLocation location() const { return {source_->name + "#" + pointer_}; }
  /// Makes an error located at this value.
  Error error(std::string message) const { return {location(), std::move(message)}; }
  /// Warns that this value is wrong: `message` says why, and what is used instead. See `Source::warn`.
  void warn(std::string_view key, const std::string& message) const;

  /// The member `key` of this object; nullopt if it is missing or null.
  std::optional<Value> find(std::string_view key) const;
  /// As `find`, but a missing member is an error.
  Value at(std::string_view key) const;
  /// The member `key`, an array of any length; nullopt if it is missing.
  std::optional<Value> find_array(std::string_view key) const;
  /// Number of elements; an error unless this is an array.
  std::size_t size() const;
  /// Element of this array; `i` must be in range.
  Value element(std::size_t i) const;
  /// The member `name` of the member "extensions"; nullopt, with a warning, if "extensions" is not an object.
  std::optional<Value> extension(std::string_view name) const;

  float number() const;  ///< finite
  bool boolean() const;
  const std::string& text() const;
  /// A non-negative whole number, at most `largest`.
  std::uint64_t integer(std::uint64_t largest = std::numeric_limits<std::int64_t>::max()) const;
  bool is_zero() const { return json_->is_number() && json_->get<double>() == 0; }
  /// An array of exactly `count` numbers.
  std::vector<float> numbers(std::size_t count) const;

  /// The name among `known` that this text is, regardless of case (with a warning if that differs); nullopt if it is
  /// none of them.
  std::optional<std::string_view> name_among(std::initializer_list<std::string_view> known) const;

  // Members with a default value. Those of a wrong kind are replaced, with a warning.
  float number(std::string_view key, float otherwise, const Range& range = {}) const;
  bool boolean(std::string_view key, bool otherwise) const;
  std::string text(std::string_view key, const std::string& otherwise) const;
  std::uint64_t integer(std::string_view key, std::uint64_t otherwise) const;  ///< an Error if it is wrong
  /// As many numbers as `otherwise` has. Where an array has fewer, the rest are those of `otherwise`.
  std::vector<float> numbers(std::string_view key, std::vector<float> otherwise, const Range& range = {}) const;
  /// A colour; negative components become 0.
  Vec3 colour(std::string_view key, const Vec3& otherwise) const;

 private:
  std::optional<float> find_number() const;
  float within(const Range& range, std::string_view key, float otherwise) const;

  const nlohmann::json* json_;
  const Source* source_;
  std::string pointer_;
};

}  // namespace lanthorn::gltf
