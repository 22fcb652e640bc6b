// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "lanthorn/scene.h"

namespace lanthorn {

/// The PLY files of a pbrt scene, according to their headers. Gzipped files are not counted.
struct ExpectedMeshes {
  std::size_t files = 0;  ///< references from shapes to files
  double faces = 0;
  double bytes = 0;  ///< of memory, including acceleration structures
};

/// Called before any of the files is read.
using MeshObserver = std::function<void(const ExpectedMeshes&)>;

/// `read_scene` for callers that want to report the size of the scene before it is loaded.
SceneDescription read_scene(const std::filesystem::path& path, const ReadOptions& options,
                            const MeshObserver& observer);

}  // namespace lanthorn
