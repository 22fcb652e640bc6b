// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "value_types.h"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <span>
#include <system_error>

#include "lanthorn/file.h"

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

namespace {

template <class Value>
std::optional<Value> within(std::optional<Value> value, Value low, Value high) {
  if (value && (*value < low || *value > high)) value.reset();
  return value;
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

// Whole numbers with separators between them; nullopt for any other text.
template <std::size_t n>
std::optional<std::array<int, n>> parse_integers(std::string_view text, char separator) {
  std::array<int, n> numbers{};
  const char* next = text.data();
  const char* const end = next + text.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0 && (next == end || *next++ != separator)) return std::nullopt;
    const auto [after, error] = std::from_chars(next, end, numbers[i]);
    if (error != std::errc()) return std::nullopt;
    next = after;
  }
  return next == end ? std::optional(numbers) : std::nullopt;
}

// The two parts of "a:b"; nullopt without the separator.
std::optional<std::pair<std::string_view, std::string_view>> split(std::string_view text, char separator) {
  const std::size_t at = text.find(separator);
  if (at == std::string_view::npos) return std::nullopt;
  return std::pair{text.substr(0, at), text.substr(at + 1)};
}

// "FIRST:END", counts with FIRST < END <= most.
std::optional<PassRange> parse_range(std::string_view text, std::uint64_t most) {
  const auto parts = split(text, ':');
  if (!parts) return std::nullopt;
  const auto begin = parse_count(parts->first), end = parse_count(parts->second);
  return begin && end && *begin < *end && *end <= most ? std::optional(PassRange{*begin, *end}) : std::nullopt;
}

// A value of the type, or a word that means nullopt.
template <class Value>
ValueType<std::optional<Value>> or_word(const ValueType<Value>& type, const std::string& word) {
  return {type.name, type.expected + ", or " + word,
          [type, word](std::string_view text) {
            std::optional<std::optional<Value>> choice;
            if (const auto value = type.parse(text); value || text == word) choice.emplace(value);
            return choice;
          },
          [type, word](const std::optional<Value>& value) { return value ? type.print(*value) : word; }};
}

std::optional<double> parse_frame(std::string_view text) {
  const auto parts = split(text, '@');
  if (!parts) return std::nullopt;
  const auto frame = parse_number(parts->first), per_second = parse_number(parts->second);
  constexpr double fewest = 1e-3;
  return frame && per_second && *per_second >= fewest ? std::optional(*frame / *per_second) : std::nullopt;
}

}  // namespace

ValueType<std::uint64_t> count_type(CountRange range) {
  return {"COUNT", describe(range),
          [range](std::string_view text) { return within(parse_count(text), range.low, range.high); },
          [](std::uint64_t count) { return std::to_string(count); }};
}

template <class Number>
ValueType<Number> number_type(NumberRange range) {
  return {"NUMBER", describe(range),
          [range](std::string_view text) {
            const auto number = within(parse_number(text), range.low, range.high);
            return number ? std::optional(static_cast<Number>(*number)) : std::nullopt;
          },
          [](Number number) { return fmt::format("{}", number); }};
}
template ValueType<double> number_type(NumberRange range);
template ValueType<float> number_type(NumberRange range);

ValueType<std::optional<float>> number_or_word_type(NumberRange range, const std::string& word) {
  return or_word(number_type<float>(range), word);
}

ValueType<double> duration_type() {
  return {"TIME", "a duration such as 30s, 5m or 2h", parse_duration,
          [](double seconds) { return fmt::format("{}s", seconds); }};
}

ValueType<double> share_type() {
  return {"SHARE", "a share such as 2% or 0.02", parse_share, [](double share) { return fmt::format("{}", share); }};
}

ValueType<std::optional<double>> duration_or_none_type() { return or_word(duration_type(), "none"); }

ValueType<std::uint64_t> bytes_type() {
  return {"SIZE", "a size such as 512M or 2G", parse_bytes, [](std::uint64_t bytes) { return std::to_string(bytes); }};
}

ValueType<std::string> text_type(const std::string& name) {
  return {name, name, [](std::string_view text) { return std::optional<std::string>(text); },
          [](const std::string& text) { return text; }};
}

ValueType<std::string> existing_file_type() { return existing_file_or_word_type({}); }

ValueType<std::string> existing_file_or_word_type(const std::vector<std::string>& words) {
  const auto parse = [words](std::string_view text) {
    std::error_code code;
    const auto status = std::filesystem::status(text, code);
    const bool is_file = std::filesystem::exists(status) && !std::filesystem::is_directory(status);
    const bool is_known = is_file || std::find(words.begin(), words.end(), text) != words.end();
    return is_known ? std::optional<std::string>(text) : std::nullopt;
  };
  const std::string expected =
      words.empty() ? "an existing file" : fmt::format("an existing file, or {}", fmt::join(words, " or "));
  return {"FILE", expected, parse, [](const std::string& text) { return text; }, words, file_names_beside};
}

ValueType<std::pair<std::string, std::string>> setting_type() {
  using Setting = std::pair<std::string, std::string>;
  const auto parse = [](std::string_view text) {
    const auto parts = split(text, '=');
    return parts && !parts->first.empty() ? std::optional<Setting>(*parts) : std::nullopt;
  };
  return {"NAME=VALUE", "name=value", parse,
          [](const Setting& setting) { return setting.first + "=" + setting.second; }};
}

ValueType<std::vector<std::string>> word_list_type(const std::vector<std::string>& known) {
  using Words = std::vector<std::string>;
  const auto parse = [known](std::string_view text) {
    std::optional<Words> words(std::in_place);
    while (words) {
      const std::size_t comma = std::min(text.find(','), text.size());
      words->emplace_back(text.substr(0, comma));
      if (std::find(known.begin(), known.end(), words->back()) == known.end()) return std::optional<Words>();
      if (comma == text.size()) return words;
      text.remove_prefix(comma + 1);
    }
    return words;
  };
  return {"LIST", fmt::format("one or more of {}, with commas between them", fmt::join(known, ",")), parse,
          [](const Words& words) { return fmt::format("{}", fmt::join(words, ",")); }, known};
}

ValueType<std::array<int, 2>> resolution_type() {
  using Size = std::array<int, 2>;
  const auto parse = [](std::string_view text) -> std::optional<Size> {
    if (const auto width = parse_integers<1>(text, 'x'); width && width->front() > 0) return Size{width->front(), 0};
    return parse_integers<2>(text, 'x');
  };
  return {"WIDTHxHEIGHT", "WIDTHxHEIGHT or WIDTH, e.g. 640x480 or 640", parse, [](const Size& size) {
            return size[1] == 0 ? fmt::format("{}", size[0]) : fmt::format("{}x{}", size[0], size[1]);
          }};
}

ValueType<std::array<int, 4>> pixel_window_type() {
  return {"X0,Y0,X1,Y1", "x0,y0,x1,y1 in pixels", [](std::string_view text) { return parse_integers<4>(text, ','); },
          [](const std::array<int, 4>& window) { return fmt::format("{}", fmt::join(window, ",")); }};
}

ValueType<PassRange> pass_range_type() {
  return {"FIRST:END", fmt::format("FIRST:END with FIRST < END, {} at most, e.g. 0:50", most_passes),
          [](std::string_view text) { return parse_range(text, most_passes); },
          [](const PassRange& range) { return fmt::format("{}:{}", range.begin, range.end); }};
}

ValueType<FrameRange> frame_range_type() {
  const auto parse = [](std::string_view text) -> std::optional<FrameRange> {
    constexpr std::uint64_t most = 10'000'000;
    constexpr double slowest = 1e-3;
    FrameRange frames;
    if (const auto rate = split(text, '@')) {
      const auto per_second = parse_number(rate->second);
      if (!per_second || !(*per_second >= slowest)) return std::nullopt;
      frames.per_second = *per_second;
      text = rate->first;
    }
    const auto range = parse_range(text, most);
    if (!range) return std::nullopt;
    frames.begin = range->begin, frames.end = range->end;
    return frames;
  };
  return {"FIRST:END[@FPS]", "FIRST:END or FIRST:END@FPS with FIRST < END, e.g. 0:48@24", parse,
          [](const FrameRange& f) {
            const std::string range = fmt::format("{}:{}", f.begin, f.end);
            return f.per_second == FrameRange().per_second ? range : fmt::format("{}@{}", range, f.per_second);
          }};
}

ValueType<double> animation_time_type() {
  constexpr std::string_view prefix = "frame=";
  const auto parse = [prefix](std::string_view text) {
    return text.starts_with(prefix) ? parse_frame(text.substr(prefix.size())) : parse_seconds(text);
  };
  return {"TIME", "seconds such as 1.5, or a frame such as frame=36@24: frame 36 at 24 frames a second", parse,
          [](double seconds) { return fmt::format("{}", seconds); }};
}

}  // namespace lanthorn::program
