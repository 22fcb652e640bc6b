// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "io/pbrt/tokenizer.h"
#include "lanthorn/file.h"

namespace lanthorn::pbrt {

/// Evidence of a file's version, such as `Film "image"`.
struct VersionSign {
  bool is_v3 = false;
  std::string text;
  SourceLocation location;
};

/// Finds the first feature in the file, or in one that it includes, that only pbrt-v3 or only pbrt-v4 has, and reads no
/// further. nullopt if there is none, or if the file is malformed, which the parser reports later. `read_included`
/// returns included files by name.
std::optional<VersionSign> find_version_sign(std::string_view text, const std::string& name,
                                             const FileReader& read_included);

/// For messages about an unknown kind: "; it is of pbrt-v4, but …" if the other version has the kind. Otherwise empty.
std::string version_hint(const std::optional<VersionSign>& sign, std::string_view directive, std::string_view kind);

}  // namespace lanthorn::pbrt
