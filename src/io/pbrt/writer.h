// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "io/pbrt/directive.h"

namespace lanthorn::pbrt {

/// Writes directives as the text of a pbrt-v4 file. Numbers round-trip exactly.
class Writer {
 public:
  /// Input file names are relative to `folder`, output file names to `target`. Both are canonical.
  Writer(std::filesystem::path folder, std::filesystem::path target)
      : folder_(std::move(folder)), target_(std::move(target)) {}

  void write(const Directive& d);
  std::string text() && { return std::move(text_); }

 private:
  void begin_line(std::size_t extra_indent);
  void write_word(std::string_view word);
  void write_numbers(const Directive& d, std::size_t count);
  void write_parameter(const Directive& d, const Parameter& p);
  std::string moved(const std::string& file) const;

  std::filesystem::path folder_, target_;
  std::string text_;
  std::size_t indent_ = 0, line_start_ = 0;
};

}  // namespace lanthorn::pbrt
