// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/plain_value.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "lanthorn/text.h"

namespace lanthorn::plain {

namespace {

constexpr std::size_t most_shown = 4;  // entries of a list in a message

std::string text_of_number(double number) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  std::string text(digits.data(), end);
  if (text.find_first_not_of("-0123456789") == std::string::npos) text += ".0";
  return text;
}

std::string text_of_array(const Array& array) {
  std::string text = "an array of shape (";
  for (const std::size_t extent : array.shape) text.append(std::to_string(extent)).append(", ");
  return text.substr(0, text.size() - (array.shape.empty() ? 0 : 2)) + ")";
}

std::string text_of_list(const List& list) {
  std::string text = "[";
  for (std::size_t i = 0; i < std::min(list.size(), most_shown); ++i)
    text.append(i > 0 ? ", " : "").append(shown(list[i]));
  return text + (list.size() > most_shown ? ", ...]" : "]");
}

struct Shower {
  std::string operator()(std::monostate) const { return "None"; }
  std::string operator()(bool flag) const { return flag ? "True" : "False"; }
  std::string operator()(std::int64_t number) const { return std::to_string(number); }
  std::string operator()(std::uint64_t number) const { return std::to_string(number); }
  std::string operator()(double number) const { return text_of_number(number); }
  std::string operator()(const std::string& text) const { return "'" + text + "'"; }
  std::string operator()(const Array& array) const { return text_of_array(array); }
  std::string operator()(const List& list) const { return text_of_list(list); }
  std::string operator()(const Dict& dict) const { return dict.entries().empty() ? "{}" : "{...}"; }
  std::string operator()(const Other& other) const { return other.shown; }
};

}  // namespace

const Value* Dict::find(std::string_view name) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.first == name; });
  return found == entries_.end() ? nullptr : &found->second;
}

void Dict::set(std::string name, Value value) { entries_.emplace_back(std::move(name), std::move(value)); }

std::string shown(const Value& value) {
  return excerpt(std::visit(Shower(), static_cast<const Value::variant&>(value)));
}

}  // namespace lanthorn::plain
