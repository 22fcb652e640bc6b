// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Types of command-line values: their names in the help, how they are parsed and printed.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lanthorn/render_options.h"

namespace lanthorn::program {

// Quantities with their units, as users type them.

/// A whole number: "500000", "200k", "1.5M", "2G" (powers of 1000), "1e6". nullopt for any other text.
std::optional<std::uint64_t> parse_count(std::string_view text);
/// Seconds, with or without a unit: "90", "30s", "1.5m", "-2h". nullopt for any other text.
std::optional<double> parse_seconds(std::string_view text);
/// Seconds, more than 0. nullopt for any other text.
std::optional<double> parse_duration(std::string_view text);
/// Bytes, at least one: "65536", "64k", "512M", "2G" (powers of 1024; "MB" and "MiB" mean the same). nullopt for any
/// other text.
std::optional<std::uint64_t> parse_bytes(std::string_view text);
/// A fraction in (0, 1]: "2%", "0.02". nullopt for any other text.
std::optional<double> parse_share(std::string_view text);
/// A finite number: "1.5", "+1", "-2e-3". nullopt for any other text.
std::optional<double> parse_number(std::string_view text);

/// Random numbers identify a pass by 32 bits: passes beyond these would repeat earlier ones.
inline constexpr std::uint64_t most_passes = std::numeric_limits<std::uint32_t>::max();

template <class Value>
struct ValueType {
  std::string name;      ///< in the help, such as COUNT, FILE or rgb|spectral; completion depends on it
  std::string expected;  ///< in messages: "a count of 1 or more, such as 500000, 200k or 1M"
  std::function<std::optional<Value>(std::string_view)> parse;  ///< nullopt for text that is not `expected`
  std::function<std::string(const Value&)> print;               ///< text that `parse` reads as this value
  std::vector<std::string> words{};                             ///< words that `parse` accepts, for messages
  /// Further words that may have been meant by text that is not `expected`.
  std::function<std::vector<std::string>(std::string_view)> similar = [](std::string_view) {
    return std::vector<std::string>();
  };
};

/// The range of a value, both ends included.
struct CountRange {
  std::uint64_t low = 0, high = std::numeric_limits<std::uint64_t>::max();
};
struct NumberRange {
  double low = -std::numeric_limits<double>::max(), high = std::numeric_limits<double>::max();
};

ValueType<std::uint64_t> count_type(CountRange range = {});
/// A finite float or double.
template <class Number = double>
ValueType<Number> number_type(NumberRange range = {});
/// A number, or `word`, which means nullopt.
ValueType<std::optional<float>> number_or_word_type(NumberRange range, const std::string& word);
ValueType<double> duration_type();
ValueType<double> share_type();
/// A duration, or "none", which means nullopt.
ValueType<std::optional<double>> duration_or_none_type();
ValueType<std::uint64_t> bytes_type();
/// Any text. `name` says what it is: FILE, INTEGRATOR, HOST:PORT.
ValueType<std::string> text_type(const std::string& name);
/// The name of an existing file that is not a folder.
ValueType<std::string> existing_file_type();
/// An existing file, or one of these words.
ValueType<std::string> existing_file_or_word_type(const std::vector<std::string>& words);
/// NAME=VALUE; the name must not be empty.
ValueType<std::pair<std::string, std::string>> setting_type();
/// One or more words of `known`, separated by commas.
ValueType<std::vector<std::string>> word_list_type(const std::vector<std::string>& known);
/// WIDTHxHEIGHT, or WIDTH alone, which gives height 0.
ValueType<std::array<int, 2>> resolution_type();
ValueType<std::array<int, 4>> pixel_window_type();
/// FIRST:END, counts.
ValueType<PassRange> pass_range_type();
/// Frames of an animation.
struct FrameRange {
  std::uint64_t begin = 0, end = 0;  ///< end excluded
  double per_second = 24;
  friend bool operator==(const FrameRange&, const FrameRange&) = default;
};
/// FIRST:END, or FIRST:END@FPS.
ValueType<FrameRange> frame_range_type();
/// Seconds, or a frame: frame=36@24 is frame 36 at 24 a second.
ValueType<double> animation_time_type();

/// One of a few words.
template <class Value>
ValueType<Value> choice_type(const std::vector<std::pair<std::string, Value>>& known) {
  std::vector<std::string> words;
  words.reserve(known.size());
  for (const auto& [word, value] : known) words.push_back(word);
  return {fmt::format("{}", fmt::join(words, "|")), fmt::format("{}", fmt::join(words, " or ")),
          [known](std::string_view text) {
            const auto found =
                std::find_if(known.begin(), known.end(), [&](const auto& entry) { return entry.first == text; });
            return found == known.end() ? std::nullopt : std::optional<Value>(found->second);
          },
          [known](const Value& value) {
            return std::find_if(known.begin(), known.end(), [&](const auto& entry) { return entry.second == value; })
                ->first;
          },
          words};
}

}  // namespace lanthorn::program
