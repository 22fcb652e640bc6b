// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "lanthorn/scene_description.h"

namespace lanthorn {

/// The name of a file in quotes for a message; of a long one the end, which tells files apart.
std::string file_in_quotes(const std::string& name);

/// The path of the file that a scene in `folder` calls `name`. If `access` finds it elsewhere, `warn` gets a message.
/// Null for scenes that are not on disk.
std::filesystem::path find_file(const std::filesystem::path& folder, const std::string& name, const FileAccess* access,
                                const std::function<void(std::string)>& warn);

/// Looks for the scene's files. If any are missing, throws one Error that names them all; of a single one it is
/// `problem`, if whoever has read the file has more to say. If the scene is read without missing files, adds a warning
/// for each instead.
void report_missing_files(SceneDescription& scene, const FileAccess& access, const Error* problem = nullptr);

}  // namespace lanthorn
