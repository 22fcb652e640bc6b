// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Output to the terminal. Standard output carries a command's results (tables, reports): if it cannot be written, the
// command has failed. Standard error carries messages: if it cannot be written, the work continues without them.
//
// Text may come from an untrusted file. Functions that take a format string therefore escape (`printable`) each text
// argument. Functions that take a complete text write it unchanged.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <type_traits>

#include "lanthorn/text.h"

namespace lanthorn::program {

/// Escapes text; returns all other values unchanged.
template <class Value>
decltype(auto) printable_value(const Value& value) {
  if constexpr (std::is_convertible_v<const Value&, std::string_view>)
    return printable(value);
  else
    return value;
}
template <class... Values>
std::string format_printable(fmt::format_string<Values...> format, const Values&... values) {
  const auto formatted = [&format](const auto&... printed) {
    return fmt::vformat(fmt::string_view(format), fmt::make_format_args(printed...));
  };
  return formatted(printable_value(values)...);
}

/// Call first in `main`. Opens closed standard streams on /dev/null: otherwise the next file opened would get the
/// stream's descriptor and receive its messages. Writing to a closed standard output is still an error.
void open_console();

/// Suppresses messages, warnings and reports from now on, because another process writes the same ones.
void mute();

/// Writes a message to standard error; ignores failures.
void say_text(std::string_view text);
template <class... Values>
void say(fmt::format_string<Values...> format, const Values&... values) {
  say_text(format_printable<Values...>(format, values...));
}

/// Writes "warning: " and the text to standard error.
void warn_text(std::string_view text);
template <class... Values>
void warn(fmt::format_string<Values...> format, const Values&... values) {
  warn_text(format_printable<Values...>(format, values...));
}

/// Writes to standard output. Throws Error if it cannot be written.
void print_text(std::string_view text);
template <class... Values>
void print(fmt::format_string<Values...> format, const Values&... values) {
  print_text(format_printable<Values...>(format, values...));
}

/// Reports on standard output what was done. Only warns if it cannot be written: the files already are.
void announce_text(std::string_view text);
template <class... Values>
void announce(fmt::format_string<Values...> format, const Values&... values) {
  announce_text(format_printable<Values...>(format, values...));
}

/// Flushes standard output, including help. Throws Error if it cannot be written.
void finish_output();

}  // namespace lanthorn::program
