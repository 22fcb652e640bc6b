// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lanthorn/scene_description.h"

namespace lanthorn {

/// Looks for the scene's files. If several are missing, throws one Error that names them all; a single one is the error
/// of whoever reads it. If the scene is read without missing files, adds a warning for each instead.
void report_missing_files(SceneDescription& scene, const FileAccess& access);

}  // namespace lanthorn
