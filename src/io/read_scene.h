// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The readers behind `read_scene` and `read_pbrt_string` (lanthorn/scene.h).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/known_method.h"
#include "lanthorn/scene.h"

namespace lanthorn {

/// `read_scene`, except that `ReadOptions::window_glass` is not looked at.
SceneDescription read_scene_file(const std::filesystem::path& path, const ReadOptions& options,
                                 const FindMethod& methods);
/// `read_pbrt_string`.
SceneDescription read_pbrt_text(std::string_view text, const std::filesystem::path& folder, const std::string& name,
                                const FindMethod& methods);

}  // namespace lanthorn
