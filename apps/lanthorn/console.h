// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// All that the program says. Standard output holds what a command is for (tables, reports): if it cannot be written,
// the command has failed. Standard error holds messages: if they cannot be written, the work goes on without them.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace lanthorn {

/// Call first in `main`. Standard streams that are closed are opened on /dev/null, so that no file that is written
/// later takes their number and with it the messages; writing to a closed standard output stays an error. Sends
/// warnings of spdlog to standard error.
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

/// Tells on standard output what was done: files have been written, so a line that cannot be is only warned of.
void announce_text(std::string_view text);
template <class... Values>
void announce(fmt::format_string<Values...> format, Values&&... values) {
  announce_text(fmt::format(format, std::forward<Values>(values)...));
}

/// Writes what standard output still holds back, help included. Throws Error if it cannot.
void finish_output();

}  // namespace lanthorn
