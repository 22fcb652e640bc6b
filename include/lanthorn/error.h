// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace lanthorn {

/// A place in an input file. Lines and columns count from 1; 0 means "not known" (e.g. a binary file).
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;

  friend bool operator==(const SourceLocation&, const SourceLocation&) = default;
};

/// Bad scene, file or option. Thrown only where input and settings enter the library; the program catches it once, in
/// main (exit code 2). `what()` reads "file:line:column: message" without the parts that are unknown.
class Error : public std::runtime_error {
 public:
  explicit Error(std::string text) : Error(SourceLocation{}, std::move(text)) {}
  Error(SourceLocation location, std::string text)
      : std::runtime_error(describe(location, text)), where(std::move(location)), message(std::move(text)) {}

  SourceLocation where;
  std::string message;

 private:
  static std::string describe(const SourceLocation& at, const std::string& what_happened) {
    std::string text = at.file;  // GCC 12 falsely warns of overlapping copies for operator+
    if (at.line > 0) text.append(":").append(std::to_string(at.line));
    if (at.line > 0 && at.column > 0) text.append(":").append(std::to_string(at.column));
    return text.empty() ? what_happened : text + ": " + what_happened;
  }
};

}  // namespace lanthorn
