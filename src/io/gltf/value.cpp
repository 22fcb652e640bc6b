// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/value.h"

#include <fmt/format.h>

#include <algorithm>
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

std::string description_of(const Range& range) {
  const char* const above = range.has_least ? "at least" : "above";
  if (!std::isfinite(range.least)) return "a number";
  if (!std::isfinite(range.most)) return fmt::format("{} {}", above, range.least);
  if (range.has_least && range.has_most) return fmt::format("between {} and {}", range.least, range.most);
  return fmt::format("{} {} and {} {}", above, range.least, range.has_most ? "at most" : "below", range.most);
}

bool is_same_without_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

void Value::warn(std::string_view key, const std::string& message) const {
  source_->warn(*this, std::string(key), message);
}

std::optional<Value> Value::find(std::string_view key) const {
  if (!json_->is_object()) throw error("must be an object");
  const auto it = json_->find(std::string(key));
  if (it == json_->end()) return {};
  Value member(*it, pointer_ + "/" + escaped(key), *source_);
  if (!it->is_null()) return member;
  member.warn("null", fmt::format("{} is null: read as if it were missing", printable(key)));
  return {};
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

Value Value::element(std::size_t i) const { return {(*json_)[i], pointer_ + "/" + std::to_string(i), *source_}; }

std::optional<Value> Value::extension(std::string_view name) const {
  const auto extensions = find("extensions");
  if (!extensions) return {};
  if (extensions->is_object()) return extensions->find(name);
  extensions->warn("extensions", "extensions must be an object: ignored");
  return {};
}

std::optional<float> Value::find_number() const {
  if (!json_->is_number()) return {};
  const auto value = json_->get<double>();
  if (!(std::fabs(value) <= static_cast<double>(std::numeric_limits<float>::max()))) return {};
  return static_cast<float>(value);
}

float Value::number() const {
  if (!json_->is_number()) throw error("must be a number");
  const auto value = find_number();
  if (!value) throw error("is too large a number");
  return *value;
}

float Value::within(const Range& range, std::string_view key, float otherwise) const {
  const auto value = find_number();
  if (value && range.contains(*value)) return *value;
  float used = otherwise;
  if (value && *value <= range.least && range.has_least) used = range.least;
  if (value && *value >= range.most && range.has_most) used = range.most;
  warn(key, fmt::format("{} must be {}, but is {}: {}", key, description_of(range),
                        value                ? fmt::format("{}", *value)
                        : json_->is_number() ? "too large"
                                             : json_->type_name(),
                        std::isfinite(used) ? fmt::format("{} is used", used) : "ignored"));
  return used;
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

std::optional<std::string_view> Value::name_among(std::initializer_list<std::string_view> known) const {
  const std::string& name = text();
  const auto* const found =
      std::find_if(known.begin(), known.end(), [&](std::string_view k) { return is_same_without_case(k, name); });
  if (found == known.end()) return {};
  if (*found != name) warn(*found, fmt::format("{} is not written {}: read as {}", *found, in_quotes(name), *found));
  return *found;
}

float Value::number(std::string_view key, float otherwise, const Range& range) const {
  const auto value = find(key);
  return value ? value->within(range, key, otherwise) : otherwise;
}

bool Value::boolean(std::string_view key, bool otherwise) const {
  const auto value = find(key);
  if (!value) return otherwise;
  if (value->json_->is_boolean()) return value->boolean();
  value->warn(key, fmt::format("{} must be true or false: {} is used", key, otherwise));
  return otherwise;
}

std::string Value::text(std::string_view key, const std::string& otherwise) const {
  const auto value = find(key);
  if (!value) return otherwise;
  if (value->json_->is_string()) return value->text();
  value->warn(key, fmt::format("{} must be a string: {} is used", key, in_quotes(otherwise)));
  return otherwise;
}

std::uint64_t Value::integer(std::string_view key, std::uint64_t otherwise) const {
  const auto value = find(key);
  return value ? value->integer() : otherwise;
}

std::vector<float> Value::numbers(std::string_view key, std::vector<float> otherwise, const Range& range) const {
  const auto value = find(key);
  if (!value) return otherwise;
  const std::size_t count = value->json_->is_array() ? value->json_->size() : 0;
  if (count != otherwise.size())
    value->warn(key, fmt::format("{} needs {} numbers, has {}: {}", key, otherwise.size(), count,
                                 count > otherwise.size() ? "the rest are ignored" : "defaults are used for the rest"));
  for (std::size_t i = 0; i < std::min(count, otherwise.size()); ++i)
    otherwise[i] = value->element(i).within(range, key, otherwise[i]);
  return otherwise;
}

Vec3 Value::colour(std::string_view key, const Vec3& otherwise) const {
  const std::vector<float> c = numbers(key, {otherwise.x, otherwise.y, otherwise.z}, Range::at_least(0));
  return {c[0], c[1], c[2]};
}

}  // namespace lanthorn::gltf
