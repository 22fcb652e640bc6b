// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "lanthorn/error.h"
#include "lanthorn/text.h"

namespace lanthorn::pbrt {

/// A SourceLocation that is cheap to copy: `file` is owned by the reader and outlives every Place.
struct Place {
  const std::string* file = nullptr;
  int line = 0;
  int column = 0;

  SourceLocation location() const { return {file ? *file : std::string(), line, column}; }
};

enum class TokenKind : std::uint8_t { end, word, string, open, close };

/// `text` points into the file: the word, or the text between the quotes with unresolved escapes.
struct Token {
  TokenKind kind = TokenKind::end;
  std::string_view text;
  Place place;
  bool has_escapes = false;
};

/// Splits a pbrt-v4 scene file into words, quoted strings and brackets. Skips whitespace and # comments.
class Tokenizer {
 public:
  /// Both must outlive the tokenizer; `file` must also outlive its tokens' places.
  Tokenizer(std::string_view text, const std::string* file);

  /// The next token. At the end of the text, and on every later call, `end` with the place after the last character.
  /// Throws Error for an unterminated string.
  Token next();

 private:
  Place place_at(const char* p) const;
  void skip_blanks();
  Token string_token();

  const char* at_;
  const char* end_;
  const char* line_start_;
  int line_ = 1;
  const std::string* file_;
};

/// The value of a string token, with escapes (\b \f \n \r \t \\ \' \") resolved. Throws Error for any other escape.
std::string string_value(const Token& token);
/// A finite number. Underflow gives 0; throws Error at the token if it is not a number or too large.
float float_value(const Token& token);
/// Like `float_value`, in double precision but within the range of floats.
double double_value(const Token& token);
/// A 32-bit integer in decimal; throws Error at the token otherwise.
std::int32_t integer_value(const Token& token);
/// Description of the token for "expected …, found …" messages.
std::string describe(const Token& token);

}  // namespace lanthorn::pbrt
