// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reports on states and pictures, for `info`.
#pragma once

#include <cstdint>
#include <string>

namespace lanthorn::program {

enum class FileKind : std::uint8_t { state, picture, other };
/// Decided by the name's extension.
FileKind kind_of_file(const std::string& file);

/// Print what the file holds, as a table or as JSON. Throw Error if it is damaged, cannot be read, or is a picture of
/// more than `max_pixels`.
void show_state(const std::string& file, bool as_json);
void show_picture(const std::string& file, std::uint64_t max_pixels, bool as_json);

}  // namespace lanthorn::program
