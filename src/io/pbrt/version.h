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

/// What tells the version of a file: such as `Film "image"`.
struct VersionSign {
  bool is_v3 = false;
  std::string text;
  SourceLocation location;
};

/// The first thing in the file, or in one that it includes, that only one of pbrt-v3 and pbrt-v4 has. Reads no further.
/// nullopt if there is none, and where the file is wrong: whoever reads it all reports that. Included files are those
/// that `read_included` returns for their names.
std::optional<VersionSign> find_version_sign(std::string_view text, const std::string& name,
                                             const FileReader& read_included);

/// For messages about an unknown kind: "; it is of pbrt-v4, but …" if it is one of the other version. Empty otherwise.
std::string version_hint(const std::optional<VersionSign>& sign, std::string_view directive, std::string_view kind);

}  // namespace lanthorn::pbrt
