// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "quantities.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

namespace lanthorn::program {

namespace {

struct Unit {
  std::string_view name;
  double factor;
};

constexpr Unit count_units[]{{"", 1}, {"k", 1e3}, {"K", 1e3}, {"M", 1e6}, {"G", 1e9}};
constexpr Unit share_units[]{{"", 1}, {"%", 0.01}};
constexpr Unit time_units[]{{"", 1}, {"s", 1}, {"m", 60}, {"min", 60}, {"h", 3600}};
constexpr Unit byte_units[]{{"", 1}, {"k", 0x1p10}, {"K", 0x1p10}, {"M", 0x1p20}, {"G", 0x1p30}, {"T", 0x1p40}};

// A number with its unit; nullopt unless the text is exactly that and the product is finite.
std::optional<double> scaled(std::string_view text, std::span<const Unit> units) {
  double value = 0;
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, value);
  const std::string_view name(next, static_cast<std::size_t>(end - next));
  const auto unit = std::find_if(units.begin(), units.end(), [&](const Unit& u) { return u.name == name; });
  if (error != std::errc() || unit == units.end() || !std::isfinite(value * unit->factor)) return std::nullopt;
  return value * unit->factor;
}

// Numbers without fraction, exponent or unit are parsed as integers: a double cannot represent all of them.
std::optional<std::uint64_t> whole(std::string_view text, std::span<const Unit> units) {
  std::uint64_t count = 0;
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, count);
  if (error == std::errc() && next == end) return count;
  const auto value = scaled(text, units);
  if (!value || !(*value >= 0 && *value < 0x1p64) || *value != std::floor(*value)) return std::nullopt;
  return static_cast<std::uint64_t>(*value);
}

}  // namespace

std::optional<std::uint64_t> parse_count(std::string_view text) { return whole(text, count_units); }

std::optional<double> parse_seconds(std::string_view text) { return scaled(text, time_units); }

std::optional<double> parse_duration(std::string_view text) {
  const auto seconds = parse_seconds(text);
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

std::optional<double> parse_share(std::string_view text) {
  const auto share = scaled(text, share_units);
  return share && *share > 0 && *share <= 1 ? share : std::nullopt;
}

std::optional<double> parse_number(std::string_view text) { return scaled(text, std::span(count_units, 1)); }

}  // namespace lanthorn::program
