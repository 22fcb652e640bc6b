// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "lanthorn/scene_description.h"

namespace lanthorn {

/// Memory that the shapes of a scene will take.
struct SceneMemory {
  std::uint64_t triangles = 0;  ///< patches count as two
  std::uint64_t curves = 0;     ///< segments, each of the pieces that ribbons are cut into
  double geometry = 0;          ///< bytes of shapes as rays use them
  double trees = 0;             ///< bytes of Embree's trees
  double building = 0;          ///< bytes needed in addition while the largest tree is built
};

/// Counts meshes and curves as they are described: the memory that displacement and subdivision add is not known before
/// they are applied. An object counts once, however many instances it has.
SceneMemory expected_memory(const SceneDescription& scene);

/// Bytes of the images of all textures, by the headers of their files. Images that cannot be read count nothing.
std::uint64_t expected_texture_memory(const SceneDescription& scene);

/// Throws Error, with the bytes needed and those available, if the scene's geometry and textures do not fit. At most
/// `scene.access.texture_memory` bytes of textures are in memory at once; if this limit is not given, sets it to half
/// of what the geometry leaves. To be called before any image is read.
void require_scene_memory(SceneDescription& scene);

}  // namespace lanthorn
