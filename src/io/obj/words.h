// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "lanthorn/error.h"

namespace lanthorn::obj {

/// A word and its location in the file.
struct Word {
  std::string_view text;
  int line = 0;
  int column = 0;
};

/// Splits OBJ and MTL files into lines of words. A line feed, a carriage return, or both end a line. # starts a
/// comment; a backslash at the end of a line joins it with the next one.
class Words {
 public:
  /// Both must outlive this.
  Words(std::string_view text, const std::string& file);

  /// Advances to the next line that has words, skipping the rest of the current one. False at the end of the file.
  bool next_line();
  /// The next word of the current line; nullopt at its end.
  std::optional<Word> find_word();
  /// As `find_word`, but throws Error, saying that `what` is missing.
  Word word(const char* what);
  /// The rest of the line, including its inner blanks.
  Word rest();

  /// A finite number; underflow gives 0.
  float number(const char* what) { return number(word(what)); }
  float number(const Word& word) const;

  SourceLocation location(const Word& word) const { return {file_, word.line, word.column}; }
  /// The current position in the line.
  SourceLocation location() const { return {file_, line_, column()}; }

 private:
  bool ends_line(const char* c) const { return *c == '\n' || (*c == '\r' && (c + 1 == end_ || c[1] != '\n')); }
  bool at_end_of_line() const { return at_ == end_ || ends_line(at_); }
  void go_to_end_of_line() {
    while (!at_end_of_line()) ++at_;
  }
  void skip_blanks();
  int column() const { return static_cast<int>(at_ - line_start_) + 1; }

  const std::string& file_;
  const char* at_;
  const char* end_;
  const char* line_start_;
  int line_ = 1;
  bool started_ = false;
};

}  // namespace lanthorn::obj
