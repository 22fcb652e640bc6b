// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

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

}  // namespace lanthorn
