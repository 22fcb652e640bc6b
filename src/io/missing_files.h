// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "lanthorn/scene_description.h"

namespace lanthorn {

/// The name of a file in quotes for a message; long names are cut at the start, since their ends differ.
std::string file_in_quotes(const std::string& name);

/// The path of the file that a scene in `folder` calls `name`. If `access` finds it elsewhere, `warn` gets a message.
/// `access` is null for scenes that are not on disk.
std::filesystem::path find_file(const std::filesystem::path& folder, const std::string& name, const FileAccess* access,
                                const std::function<void(std::string)>& warn);

/// Adds a single warning that names the scene's files that do not exist, if any.
void warn_of_missing_files(SceneDescription& scene, const FileAccess& access);

/// Checks that the scene's files exist. If any are missing, throws a single Error that names them all; for a single
/// file, `problem` if the caller that tried to read it has a more specific error. If missing files are skipped, warns
/// instead.
void report_missing_files(SceneDescription& scene, const FileAccess& access, const Error* problem = nullptr);

}  // namespace lanthorn
