// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/in_quotes.h"

namespace lanthorn {

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 200;
  std::string result = "\"";
  for (const char c : text.substr(0, longest)) result += (c >= ' ' && c != '\x7f') || (c & '\x80') ? c : '?';
  return result + (text.size() > longest ? "...\"" : "\"");
}

}  // namespace lanthorn
