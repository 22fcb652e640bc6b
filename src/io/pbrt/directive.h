// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "io/pbrt/parameters.h"

namespace lanthorn::pbrt {

/// What follows the name of a directive in a file.
struct DirectiveForm {
  std::string_view name;
  std::size_t numbers = 0;                       ///< 16 of them are in brackets
  std::array<std::string_view, 3> strings = {};  ///< what each string is, for messages; empty: there are no more
  bool has_parameters = false;
  bool is_of_v2 = false;  ///< of pbrt-v2 alone: files of pbrt-v3 may have it, whose other directives are the same
};

/// The form of a directive of this name. Null if there is none.
const DirectiveForm* find_form(std::string_view name);

/// One directive of a file. The parser makes them; the assembler builds the scene from them, the upgrader turns those
/// of pbrt-v3 into those of pbrt-v4, the writer prints them.
struct Directive {
  std::string_view name;  ///< static text
  std::array<double, 16> numbers{};
  std::vector<std::string> strings;
  Parameters parameters;
  Place place;
};
using DirectiveSink = std::function<void(Directive)>;

/// Blocks that may be open at once.
inline constexpr std::size_t deepest_nesting = 4096;

/// Names of the directives that the parser makes around the directives of an imported file.
inline constexpr std::string_view import_begin = "Import", import_end = "end of Import";

}  // namespace lanthorn::pbrt
