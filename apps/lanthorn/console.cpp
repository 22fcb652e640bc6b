// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "console.h"

#include <fcntl.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iostream>
#include <optional>
#include <system_error>

#include "lanthorn/error.h"

namespace lanthorn::program {

namespace {

[[noreturn]] void fail(int code) {
  throw Error(fmt::format("standard output cannot be written: {}", std::generic_category().message(code)));
}

bool is_mute = false;

// Returns the error number if the text cannot be written.
std::optional<int> write_output(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return {};
  const int code = errno;
  std::clearerr(stdout);
  return code;
}

}  // namespace

void open_console() {
  // open() returns the lowest free descriptor. Standard output is opened read-only, so that writing to it still fails.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0) ::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  spdlog::set_default_logger(spdlog::stderr_color_mt("lanthorn"));
  spdlog::set_pattern("%^%l%$: %v");
}

void mute() { is_mute = true; }

void say_text(std::string_view text) {
  if (is_mute) return;
  while (!text.empty()) {
    const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    if (written < 0 && errno != EINTR) return;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void warn_text(std::string_view text) {
  if (!is_mute) spdlog::warn("{}", text);
}

void print_text(std::string_view text) {
  if (const auto code = write_output(text)) fail(*code);
}

void announce_text(std::string_view text) {
  if (is_mute) return;
  if (const auto code = write_output(text))
    warn("standard output cannot be written: {}", std::generic_category().message(*code));
}

void finish_output() {
  errno = 0;
  std::cout.flush();
  if (!std::cout.good() || std::fflush(stdout) != 0) fail(errno);
}

}  // namespace lanthorn::program
