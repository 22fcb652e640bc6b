// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/obj/words.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include "lanthorn/text.h"

namespace lanthorn::obj {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }

}  // namespace

Words::Words(std::string_view text, const std::string& file)
    : file_(file), at_(text.data()), end_(text.data() + text.size()), line_start_(text.data()) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) line_start_ = at_ += byte_order_mark.size();
}

void Words::skip_blanks() {
  while (at_ != end_) {
    if (*at_ == '\\') {
      const char* next = at_ + 1;
      if (next != end_ && *next == '\r' && !ends_line(next)) ++next;
      if (next == end_ || !ends_line(next)) return;
      at_ = line_start_ = next + 1;
      ++line_;
    } else if (*at_ == '#') {
      go_to_end_of_line();
    } else if (is_blank(*at_) && !ends_line(at_)) {
      ++at_;
    } else {
      return;
    }
  }
}

bool Words::next_line() {
  if (std::exchange(started_, true))
    while (find_word()) {
    }
  skip_blanks();
  while (at_ != end_ && at_end_of_line()) {
    line_start_ = ++at_;
    ++line_;
    skip_blanks();
  }
  return at_ != end_;
}

std::optional<Word> Words::find_word() {
  skip_blanks();
  if (at_end_of_line()) return {};
  Word word{{}, line_, column()};
  const char* first = at_;
  while (!at_end_of_line() && !is_blank(*at_)) ++at_;
  word.text = {first, static_cast<std::size_t>(at_ - first)};
  return word;
}

Word Words::word(const char* what) {
  const auto found = find_word();
  if (!found) throw Error(location(), std::string(what) + " is missing");
  return *found;
}

Word Words::rest() {
  skip_blanks();
  Word word{{}, line_, column()};
  const char* first = at_;
  go_to_end_of_line();
  const char* last = at_;
  while (last != first && is_blank(last[-1])) --last;
  word.text = {first, static_cast<std::size_t>(last - first)};
  return word;
}

float Words::number(const Word& word) const {
  std::string_view text = word.text;
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_word = !text.empty() && std::isalpha(static_cast<unsigned char>(text.back())) != 0;  // "inf", "nan"
  if (end != text.data() + text.size() || error == std::errc::invalid_argument || is_word)
    throw Error(location(word), "expected a number, found " + in_quotes(word.text));
  // "Out of range" means too large or too small; numbers that are too small have a negative exponent.
  if (error == std::errc::result_out_of_range && text.find("e-") == text.npos && text.find("E-") == text.npos)
    throw Error(location(word), "the number " + in_quotes(word.text) + " is too large");
  if (error == std::errc::result_out_of_range) return 0;
  const auto result = static_cast<float>(value);
  if (!std::isfinite(result)) throw Error(location(word), "the number " + in_quotes(word.text) + " is too large");
  return result;
}

}  // namespace lanthorn::obj
