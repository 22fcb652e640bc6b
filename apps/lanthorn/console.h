// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Output to the terminal. Standard output carries a command's results (tables, reports): if it cannot be written, the
// command has failed. Standard error carries messages: if it cannot be written, the work goes on without them.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace lanthorn::program {

/// Call first in `main`. Opens standard streams that are closed on /dev/null: otherwise a file opened later would get
/// their number, and with it the messages. Writing to a closed standard output is still an error. Sends warnings of
/// spdlog to standard error.
void open_console();

/// Writes a message to standard error, if that can be done.
void say_text(std::string_view text);
template <class... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
  say_text(fmt::format(format, std::forward<Values>(values)...));
}

/// Writes to standard output. Throws Error if it cannot be written.
void print_text(std::string_view text);
template <class... Values>
void print(fmt::format_string<Values...> format, Values&&... values) {
  print_text(fmt::format(format, std::forward<Values>(values)...));
}

/// Reports on standard output what was done. Warns if it cannot be written: the files already are.
void announce_text(std::string_view text);
template <class... Values>
void announce(fmt::format_string<Values...> format, Values&&... values) {
  announce_text(fmt::format(format, std::forward<Values>(values)...));
}

/// Flushes standard output, help included. Throws Error if it cannot be written.
void finish_output();

}  // namespace lanthorn::program
