// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "lanthorn/scene.h"

namespace lanthorn {

/// The PLY files of a pbrt scene, as their headers say. Gzipped files do not count.
struct ExpectedMeshes {
  std::size_t files = 0;  ///< uses of files by shapes
  double faces = 0;
  double bytes = 0;  ///< of memory, with search trees
};

/// Called before any of the files is read.
using MeshObserver = std::function<void(const ExpectedMeshes&)>;

/// `read_scene`, for callers that want to tell their user what the scene will take before it is loaded.
SceneDescription read_scene(const std::filesystem::path& path, const ReadOptions& options,
                            const MeshObserver& observer);

}  // namespace lanthorn
