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

}  // namespace lanthorn::pbrt
