// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reads, writes and compares the records of renders.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "lanthorn/render_record.h"

namespace lanthorn {

// By value, because one list of variables serves for writing and for reading.
nlohmann::json json_of(RenderIdentity identity);
nlohmann::json json_of(RenderRecord record);

/// The inverse of `json_of`. Throws Error at `file` if a member is missing or not what it must be.
RenderRecord read_record(const nlohmann::json& settings, const std::string& file);
/// The inverse of `settings_text`. Throws Error as above.
RenderRecord read_record(const std::string& text, const std::string& file);

/// The first difference, as the option (or file) and both values, such as "--seed (0 and 7)"; nullopt if they are
/// equal.
std::optional<std::string> identity_difference(const RenderIdentity& a, const RenderIdentity& b);

/// Width and height of the film, in pixels: the crop with its margin.
std::array<int, 2> rendered_size(const RenderIdentity& identity);

/// The members in which both agree.
RenderRecord common_record(const RenderRecord& a, const RenderRecord& b);

}  // namespace lanthorn
