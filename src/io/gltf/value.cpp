// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/value.h"

#include <cmath>
#include <utility>

#include "lanthorn/text.h"

namespace lanthorn::gltf {

namespace {

// RFC 6901, §3. Long keys are cut to the length of a token.
std::string escaped(std::string_view key) {
  constexpr std::size_t longest = 32;
  std::string result;
  for (const char c : key.substr(0, longest)) {
    if (c == '~')
      result += "~0";
    else if (c == '/')
      result += "~1";
    else
      result += c;
  }
  return printable(result);
}

}  // namespace

std::optional<Value> Value::find(std::string_view key) const {
  if (!json_->is_object()) throw error("must be an object");
  const auto it = json_->find(std::string(key));
  if (it == json_->end()) return {};
  return Value(*it, pointer_ + "/" + escaped(key), *file_);
}

Value Value::at(std::string_view key) const {
  const auto value = find(key);
  if (!value) throw error("needs the member \"" + std::string(key) + "\"");
  return *value;
}

std::optional<Value> Value::find_array(std::string_view key) const {
  auto value = find(key);
  if (value) value->size();
  return value;
}

std::size_t Value::size() const {
  if (!json_->is_array()) throw error("must be an array");
  return json_->size();
}

Value Value::element(std::size_t i) const { return {(*json_)[i], pointer_ + "/" + std::to_string(i), *file_}; }

std::optional<Value> Value::extension(std::string_view name) const {
  const auto extensions = find("extensions");
  return extensions ? extensions->find(name) : std::nullopt;
}

float Value::number() const {
  if (!json_->is_number()) throw error("must be a number");
  const auto value = json_->get<double>();
  if (!(std::fabs(value) <= static_cast<double>(std::numeric_limits<float>::max())))
    throw error("is too large a number");
  return static_cast<float>(value);
}

bool Value::boolean() const {
  if (!json_->is_boolean()) throw error("must be true or false");
  return json_->get<bool>();
}

const std::string& Value::text() const {
  if (!json_->is_string()) throw error("must be a string");
  return json_->get_ref<const std::string&>();
}

std::uint64_t Value::integer(std::uint64_t largest) const {
  // Some exporters write whole numbers as 3.0.
  const bool whole = json_->is_number_unsigned() ||
                     (json_->is_number_float() && json_->get<double>() >= 0 && json_->get<double>() < 0x1p53 &&
                      json_->get<double>() == std::floor(json_->get<double>()));
  if (!whole) throw error("must be a non-negative whole number");
  const std::uint64_t value =
      json_->is_number_unsigned() ? json_->get<std::uint64_t>() : static_cast<std::uint64_t>(json_->get<double>());
  if (value > largest) throw error("is too large: the maximum is " + std::to_string(largest));
  return value;
}

std::vector<float> Value::numbers(std::size_t count) const {
  if (size() != count) throw error("needs " + std::to_string(count) + " numbers, has " + std::to_string(json_->size()));
  std::vector<float> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(element(i).number());
  return result;
}

float Value::number(std::string_view key, float otherwise) const {
  const auto value = find(key);
  return value ? value->number() : otherwise;
}

bool Value::boolean(std::string_view key, bool otherwise) const {
  const auto value = find(key);
  return value ? value->boolean() : otherwise;
}

std::string Value::text(std::string_view key, const std::string& otherwise) const {
  const auto value = find(key);
  return value ? value->text() : otherwise;
}

std::uint64_t Value::integer(std::string_view key, std::uint64_t otherwise) const {
  const auto value = find(key);
  return value ? value->integer() : otherwise;
}

Vec3 Value::vec3(std::string_view key, const Vec3& otherwise) const {
  const auto value = find(key);
  if (!value) return otherwise;
  const std::vector<float> v = value->numbers(3);
  return {v[0], v[1], v[2]};
}

}  // namespace lanthorn::gltf
