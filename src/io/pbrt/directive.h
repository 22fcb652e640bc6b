// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Directives: their forms, and the writer that prints them.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/pbrt/parameters.h"

namespace lanthorn::pbrt {

/// Syntax of a directive after its name.
struct DirectiveForm {
  std::string_view name;
  std::size_t numbers = 0;                       ///< 16 numbers are in brackets
  std::array<std::string_view, 3> strings = {};  ///< what each string is, for messages; empty: no further strings
  bool has_parameters = false;
  bool is_of_v2 = false;  ///< only pbrt-v2 has it; accepted in pbrt-v3 files, which otherwise share its directives
};

/// The form of a directive of this name; null if there is none.
const DirectiveForm* find_form(std::string_view name);

/// One directive of a file. The parser makes directives; the assembler builds the scene from them, the upgrader
/// translates directives of pbrt-v3 to pbrt-v4, the writer prints directives.
struct Directive {
  std::string_view name;  ///< refers to a static string
  std::array<double, 16> numbers{};
  std::vector<std::string> strings;
  Parameters parameters;
  Place place;
};
using DirectiveSink = std::function<void(Directive)>;

/// Maximum depth of nested blocks.
inline constexpr std::size_t deepest_nesting = 4096;

/// Names of the pseudo-directives that the parser emits around the directives of an imported file.
inline constexpr std::string_view import_begin = "Import", import_end = "end of Import";

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
