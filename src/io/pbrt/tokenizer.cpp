// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/pbrt/tokenizer.h"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

namespace lanthorn::pbrt {

namespace {

bool ends_word(char c) {
  switch (c) {
    case ' ':
    case '\t':
    case '\r':
    case '\n':
    case '"':
    case '[':
    case ']':
    case '#':
      return true;
    default:
      return false;
  }
}

// Removes characters that std::from_chars rejects but pbrt accepts: a leading plus sign, and a trailing comma.
std::string_view bare_number(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  if (text.size() > 1 && text.back() == ',') text.remove_suffix(1);
  return text;
}

bool looks_like_number(std::string_view text) {
  const std::size_t first = text.starts_with('-') ? 1 : 0;
  return text.size() > first && ((text[first] >= '0' && text[first] <= '9') || text[first] == '.');
}

// For a number outside the range of floats: true if it is too close to 0, false if it is too large.
bool is_tiny(std::string_view text) {
  double wide = 0;
  if (std::from_chars(text.data(), text.data() + text.size(), wide).ec == std::errc{}) return std::abs(wide) < 1;
  if (const std::size_t e = text.find_first_of("eE"); e != text.npos) return text[e + 1] == '-';
  const std::size_t first = text.find_first_of("123456789.");
  return first != text.npos && text[first] == '.';
}

}  // namespace

Tokenizer::Tokenizer(std::string_view text, const std::string* file)
    : at_(text.data()), end_(text.data() + text.size()), line_start_(text.data()), file_(file) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) line_start_ = at_ += byte_order_mark.size();
}

Place Tokenizer::place_at(const char* p) const { return {file_, line_, static_cast<int>(p - line_start_) + 1}; }

void Tokenizer::skip_blanks() {
  for (; at_ != end_; ++at_) {
    if (*at_ == '\n') {
      ++line_;
      line_start_ = at_ + 1;
    } else if (*at_ == '#') {
      const void* newline = std::memchr(at_, '\n', static_cast<std::size_t>(end_ - at_));
      at_ = newline ? static_cast<const char*>(newline) - 1 : end_ - 1;
    } else if (*at_ != ' ' && *at_ != '\t' && *at_ != '\r') {
      return;
    }
  }
}

Token Tokenizer::string_token() {
  Token token{TokenKind::string, {}, place_at(at_)};
  const char* first = ++at_;
  for (; at_ != end_ && *at_ != '\n'; ++at_) {
    if (*at_ == '"') {
      token.text = {first, static_cast<std::size_t>(at_ - first)};
      ++at_;
      return token;
    }
    if (*at_ == '\\') {
      token.has_escapes = true;
      if (++at_ == end_ || *at_ == '\n') break;
    }
  }
  throw Error(token.place.location(), "the string that starts here has no closing quote on its line");
}

Token Tokenizer::next() {
  skip_blanks();
  if (at_ == end_) return {TokenKind::end, {}, place_at(at_)};
  if (*at_ == '"') return string_token();
  const char* first = at_;
  const Place place = place_at(at_);
  if (*at_ == '[' || *at_ == ']') {
    ++at_;
    return {*first == '[' ? TokenKind::open : TokenKind::close, {first, 1}, place};
  }
  do ++at_;
  while (at_ != end_ && !ends_word(*at_));
  return {TokenKind::word, {first, static_cast<std::size_t>(at_ - first)}, place};
}

std::string string_value(const Token& token) {
  if (!token.has_escapes) return std::string(token.text);
  constexpr std::string_view letters = "bfnrt\\'\"", meanings = "\b\f\n\r\t\\'\"";
  std::string value;
  for (std::size_t i = 0; i < token.text.size(); ++i) {
    char c = token.text[i];
    if (c == '\\') {
      const std::size_t letter = letters.find(token.text[++i]);
      if (letter == std::string_view::npos) {
        SourceLocation where = token.place.location();
        where.column += static_cast<int>(i);
        throw Error(where, "unknown escape " + in_quotes(token.text.substr(i - 1, 2)) + " in a string");
      }
      c = meanings[letter];
    }
    value += c;
  }
  return value;
}

namespace {

// Rejects numbers larger than a float can be.
template <class Number>
Number number_value(const Token& token) {
  const std::string_view text = bare_number(token.text);
  const char* last = text.data() + text.size();
  Number value = 0;
  auto [end, error] = std::from_chars(text.data(), last, value);
  if (token.kind != TokenKind::word || error == std::errc::invalid_argument || end != last || !looks_like_number(text))
    throw Error(token.place.location(), "expected a number, found " + describe(token));
  const bool is_out_of_range = error == std::errc::result_out_of_range;
  if (is_out_of_range ? !is_tiny(text) : std::fabs(value) > std::numeric_limits<float>::max())
    throw Error(token.place.location(), "the number " + in_quotes(text) + " is too large");
  return is_out_of_range ? 0 : value;
}

}  // namespace

double double_value(const Token& token) { return number_value<double>(token); }
float float_value(const Token& token) { return number_value<float>(token); }

std::int32_t integer_value(const Token& token) {
  const std::string_view text = bare_number(token.text);
  const char* last = text.data() + text.size();
  std::int32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (token.kind == TokenKind::word && error == std::errc::result_out_of_range && end == last)
    throw Error(token.place.location(), "the integer " + in_quotes(text) + " does not fit in 32 bits");
  if (token.kind != TokenKind::word || error != std::errc{} || end != last)
    throw Error(token.place.location(), "expected an integer, found " + describe(token));
  return value;
}

std::string describe(const Token& token) {
  switch (token.kind) {
    case TokenKind::end:
      return "the end of the file";
    case TokenKind::string:
      return "the string " + in_quotes(token.text);
    default:
      return in_quotes(token.text);
  }
}

}  // namespace lanthorn::pbrt
