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
};

/// Bad scene, file or option. Thrown at the input and settings border only, caught once in main (exit code 2).
/// `what()` reads "file:line:column: message", leaving out what is not known.
class Error : public std::runtime_error {
 public:
  explicit Error(std::string message) : Error(SourceLocation{}, std::move(message)) {}
  Error(SourceLocation location, std::string message)
      : std::runtime_error(describe(location, message)), where(std::move(location)), message(std::move(message)) {}

  SourceLocation where;
  std::string message;

 private:
  static std::string describe(const SourceLocation& at, const std::string& message) {
    std::string text = at.file;
    if (at.line > 0) text += ":" + std::to_string(at.line);
    if (at.line > 0 && at.column > 0) text += ":" + std::to_string(at.column);
    return text.empty() ? message : text + ": " + message;
  }
};

}  // namespace lanthorn
