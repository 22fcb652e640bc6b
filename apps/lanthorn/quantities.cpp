// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "quantities.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <span>
#include <utility>

namespace lanthorn::program {

namespace {

struct Unit {
  std::string_view name;
  double factor;
};

constexpr Unit count_units[]{{"", 1}, {"k", 1e3}, {"K", 1e3}, {"M", 1e6}, {"G", 1e9}};
constexpr Unit time_units[]{{"", 1}, {"s", 1}, {"m", 60}, {"min", 60}, {"h", 3600}};
constexpr Unit byte_units[]{{"", 1}, {"k", 0x1p10}, {"K", 0x1p10}, {"M", 0x1p20}, {"G", 0x1p30}, {"T", 0x1p40}};

// A number and its unit; nothing unless the text is just that and the product finite.
std::optional<double> scaled(std::string_view text, std::span<const Unit> units) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, value);
  const std::string_view name(next, static_cast<std::size_t>(end - next));
  const auto unit = std::find_if(units.begin(), units.end(), [&](const Unit& u) { return u.name == name; });
  if (error != std::errc() || unit == units.end() || !std::isfinite(value * unit->factor)) return std::nullopt;
  return value * unit->factor;
}

// Digits alone are read as they are: a double has not room for all of them.
std::optional<std::uint64_t> whole(std::string_view text, std::span<const Unit> units) {
  std::uint64_t count = 0;
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, count);
  if (error == std::errc() && next == end) return count;
  const auto value = scaled(text, units);
  if (!value || !(*value >= 0 && *value < 0x1p64) || *value != std::floor(*value)) return std::nullopt;
  return static_cast<std::uint64_t>(*value);
}

template <class Value>
CLI::Option* add_option_of(CLI::App& command, const std::string& names, const std::string& help, const char* type,
                           const std::string& expected, std::function<std::optional<Value>(std::string_view)> parse,
                           std::function<void(Value)> set) {
  const std::string name = names.substr(names.find("--"));
  const auto take = [name, expected, parse = std::move(parse), set = std::move(set)](const std::string& text) {
    const std::optional<Value> value = parse(text);
    if (!value) throw CLI::ValidationError(fmt::format("{} {}: expected {}", name, text, expected));
    set(*value);
  };
  return command.add_option_function<std::string>(names, take, help)->type_name(type);
}

template <class Value>
std::function<std::optional<Value>(std::string_view)> within(std::optional<Value> (*parse)(std::string_view), Value low,
                                                             Value high) {
  return [=](std::string_view text) {
    std::optional<Value> value = parse(text);
    if (value && (*value < low || *value > high)) value.reset();
    return value;
  };
}

std::string describe(const CountRange& range) {
  constexpr const char* examples = ", such as 500000, 200k or 1M";
  if (range.high == CountRange{}.high) return fmt::format("a count of {} or more{}", range.low, examples);
  return fmt::format("a count from {} to {}{}", range.low, range.high, range.high < 1'000'000 ? "" : examples);
}

std::string describe(const NumberRange& range) {
  const bool below = range.low > NumberRange{}.low, above = range.high < NumberRange{}.high;
  if (below && above) return fmt::format("a number from {:g} to {:g}", range.low, range.high);
  if (below) return fmt::format("a number of {:g} or more", range.low);
  return above ? fmt::format("a number of {:g} at most", range.high) : "a number";
}

}  // namespace

std::optional<std::uint64_t> parse_count(std::string_view text) { return whole(text, count_units); }

std::optional<double> parse_duration(std::string_view text) {
  const auto seconds = scaled(text, time_units);
  return seconds && *seconds > 0 ? seconds : std::nullopt;
}

std::optional<std::uint64_t> parse_bytes(std::string_view text) {
  std::string_view number = text;
  for (const std::string_view ending : {"iB", "B"})
    if (number.ends_with(ending)) {
      number.remove_suffix(ending.size());
      break;
    }
  const auto bytes = whole(number, byte_units);
  return bytes && *bytes > 0 ? bytes : std::nullopt;
}

std::optional<double> parse_number(std::string_view text) { return scaled(text, std::span(count_units, 1)); }

CLI::Option* add_count_option(CLI::App& command, const std::string& names, const std::string& help, CountRange range,
                              std::function<void(std::uint64_t)> set) {
  return add_option_of<std::uint64_t>(command, names, help, "COUNT", describe(range),
                                      within(parse_count, range.low, range.high), std::move(set));
}

CLI::Option* add_number_option(CLI::App& command, const std::string& names, const std::string& help, NumberRange range,
                               std::function<void(double)> set) {
  return add_option_of<double>(command, names, help, "NUMBER", describe(range),
                               within(parse_number, range.low, range.high), std::move(set));
}

CLI::Option* add_number_option(CLI::App& command, const std::string& names, const std::string& help, NumberRange range,
                               const std::string& word, std::function<void(std::optional<double>)> set) {
  using Choice = std::optional<double>;
  const auto parse = [word, number = within(parse_number, range.low, range.high)](std::string_view text) {
    std::optional<Choice> choice;
    if (const Choice value = number(text); value || text == word) choice.emplace(value);
    return choice;
  };
  return add_option_of<Choice>(command, names, help, "NUMBER", describe(range) + ", or " + word, parse, std::move(set));
}

CLI::Option* add_duration_option(CLI::App& command, const std::string& names, const std::string& help,
                                 std::function<void(double)> set) {
  return add_option_of<double>(command, names, help, "TIME", "a duration such as 30s, 5m or 2h", parse_duration,
                               std::move(set));
}

CLI::Option* add_bytes_option(CLI::App& command, const std::string& names, const std::string& help,
                              std::function<void(std::uint64_t)> set) {
  return add_option_of<std::uint64_t>(command, names, help, "SIZE", "a size such as 512M or 2G", parse_bytes,
                                      std::move(set));
}

}  // namespace lanthorn::program
