// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace lanthorn::program {

constexpr int one_line = -1;  ///< as the indent: no line feeds

/// JSON for a report or a client, in ASCII: control characters and all other characters beyond ASCII are written as
/// \uNNNN, since a terminal may show the text. U+FFFD replaces invalid UTF-8. `indent`: of nested values.
inline std::string json_text(const nlohmann::json& json, int indent) {
  return json.dump(indent, ' ', /*ensure_ascii=*/true, nlohmann::json::error_handler_t::replace);
}

/// A report as it is printed, or written to a file.
inline std::string report_text(const nlohmann::json& json) { return json_text(json, 2) + '\n'; }

}  // namespace lanthorn::program
