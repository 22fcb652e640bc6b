// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// JSON of reports, of answers to clients and of the metadata of pictures.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "lanthorn/error_estimate.h"
#include "lanthorn/render_record.h"
#include "lanthorn/scene.h"

namespace lanthorn::program {

constexpr int one_line = -1;  ///< as `indent`: no line breaks

/// JSON for a report or a client, in ASCII, because a terminal may show it: control characters and non-ASCII characters
/// are written as \uNNNN. U+FFFD replaces invalid UTF-8. `indent`: spaces per nesting level.
inline std::string json_text(const nlohmann::json& json, int indent) {
  return json.dump(indent, ' ', /*ensure_ascii=*/true, nlohmann::json::error_handler_t::replace);
}

/// The text of a report, to be printed or written to a file.
inline std::string report_text(const nlohmann::json& json) { return json_text(json, 2) + '\n'; }

/// The record of a render for a report, a client or a picture's metadata.
inline nlohmann::json settings_json(const RenderRecord& record) { return nlohmann::json::parse(settings_text(record)); }

/// The value; null if there is none.
template <class Value>
nlohmann::json or_null(const std::optional<Value>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

/// The estimate's members by their names.
nlohmann::json estimate_json(const ErrorEstimate& error);

/// Summary for `info --json` and for reports of renders.
nlohmann::json scene_json(const SceneSummary& scene);

}  // namespace lanthorn::program
