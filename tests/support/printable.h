// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sstream>
#include <string>

#include "lanthorn/text.h"

namespace lanthorn::test {

/// True if a terminal only shows the text: it holds nothing but printable characters and line feeds.
inline bool is_printable(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (printable(line) != line) return false;
  return true;
}

}  // namespace lanthorn::test
