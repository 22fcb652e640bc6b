// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace lanthorn {

namespace {

constexpr int longest = 32;  // maximum number of characters of a file's text in a message

// The UTF-8 character at the start of a text; `bytes` is 0 if there is none.
struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;
};

Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead >= 0xf0 && lead < 0xf8 ? 4 : lead >= 0xe0 && lead < 0xf0 ? 3 : lead < 0xe0 ? 2 : 0;
  if (lead < 0xc0 || bytes == 0 || text.size() < bytes) return {};
  std::uint32_t code = lead & (0x7fu >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3fu);
  }
  constexpr std::uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  return code < smallest[bytes] || code > 0x10ffff || is_surrogate ? Character{} : Character{code, bytes};
}

// False for control characters, invisible characters and those that change the writing direction.
bool is_printable(std::uint32_t code) {
  if (code < 0x20 || (code >= 0x7f && code < 0xa0)) return false;
  return !(code >= 0x200b && code <= 0x200f) && !(code >= 0x2028 && code <= 0x202e) &&
         !(code >= 0x2060 && code <= 0x206f) && code != 0xfeff;
}

// Appends the first character of `text`, or its bytes in hexadecimal; returns the number of bytes consumed.
std::size_t append_first(std::string& result, std::string_view text) {
  const Character c = first_character(text);
  if (c.bytes > 0 && is_printable(c.code)) {
    result += text.substr(0, c.bytes);
    return c.bytes;
  }
  const std::size_t bytes = c.bytes > 0 ? c.bytes : 1;
  for (const char byte : text.substr(0, bytes)) result += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
  return bytes;
}

// $'...' with everything except printable ASCII as octal escapes.
std::string escaped_word(const std::string& text) {
  std::string word = "$'";
  for (const char c : text) {
    if (c == '\'' || c == '\\')
      word += {'\\', c};
    else if (c >= ' ' && c <= '~')
      word += c;
    else
      word += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
  }
  return word + "'";
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) text.remove_prefix(append_first(result, text));
  return result;
}

std::string excerpt(std::string_view text) {
  std::string result;
  for (int i = 0; i < longest && !text.empty(); ++i) text.remove_prefix(append_first(result, text));
  return result + (text.empty() ? "" : "...");
}

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (int i = 0; i < longest && !text.empty(); ++i) {
    if (text.front() == '"' || text.front() == '\\') result += '\\';
    text.remove_prefix(append_first(result, text));
  }
  return result + (text.empty() ? "\"" : "...\"");
}

std::string quoted_list(std::span<const std::string> names) {
  constexpr std::size_t most = 8;
  std::string result;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) result += (i > 0 ? ", " : "") + in_quotes(names[i]);
  return result + (names.size() > most ? ", ..." : "");
}

std::string without_quotations(std::string_view message) {
  std::string result;
  bool quoted = false;
  for (std::size_t i = 0; i < message.size(); ++i) {
    if (quoted && message[i] == '\\') {
      ++i;
    } else if (message[i] == '"') {
      quoted = !quoted;
      result += quoted ? "\"..." : "\"";
    } else if (!quoted) {
      result += message[i];
    }
  }
  return result;
}

std::string format_duration(double seconds) {
  const auto s = static_cast<std::int64_t>(std::max(0.0, seconds) + 0.5);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{}:{:02} min", s / 60, s % 60);
  return fmt::format("{}:{:02}:{:02} h", s / 3600, s / 60 % 60, s % 60);
}

namespace {

constexpr std::size_t longest_word = 64;  // longer words are not typing errors
constexpr std::size_t shortest_beginning = 3;

// Optimal string alignment distance: Levenshtein distance in which swapping neighbours costs 1.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Rows i - 2, i - 1 and i of the table of distances between prefixes.
  std::array<std::vector<std::size_t>, 3> rows;
  for (auto& row : rows) row.resize(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) rows[2][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::rotate(rows.begin(), rows.begin() + 1, rows.end());
    const std::vector<std::size_t>&two_before = rows[0], &before = rows[1];
    std::vector<std::size_t>& row = rows[2];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({before[j] + 1, row[j - 1] + 1, before[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], two_before[j - 2] + 1);
    }
  }
  return rows[2][b.size()];
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string> known) {
  if (word.size() > longest_word) return std::nullopt;
  const std::string* best = nullptr;
  std::size_t fewest = 0;
  for (const std::string& name : known) {
    const std::size_t edits = edit_distance(word, name);
    if (3 * edits > std::max<std::size_t>(3, name.size()) || edits >= name.size()) continue;
    if (best && edits >= fewest) continue;
    best = &name;
    fewest = edits;
  }
  if (best) return *best;
  const auto begins = [&](const std::string& name) { return name.starts_with(word); };
  if (word.size() < shortest_beginning || std::count_if(known.begin(), known.end(), begins) != 1) return std::nullopt;
  return *std::find_if(known.begin(), known.end(), begins);
}

std::string did_you_mean(std::string_view word, std::span<const std::string> known) {
  const auto name = nearest_name(word, known);
  return name ? "; did you mean " + *name + "?" : "";
}

std::string short_number(double number) {
  const double size = std::fabs(number);
  return size >= 99.5 && size < 1e6 ? fmt::format("{:.0f}", number) : fmt::format("{:.2g}", number);
}

std::string shell_word(const std::string& text) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-+=,:/@%";
  if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
  if (printable(text) != text) return escaped_word(text);
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

}  // namespace lanthorn
