// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Detects ground planes and backdrops, which are far larger than the objects on them.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "lanthorn/scene_description.h"

namespace lanthorn {

/// Removes grounds from a scene, so that a view can frame the objects on them. A ground is a mesh that is flat along a
/// world axis along which the whole scene is also flat, and whose bounding box is at least four times as large as the
/// box of all other meshes: in a view of everything, these would be small. All grounds of a scene are on the same side
/// of the other meshes.
class Grounds {
 public:
  explicit Grounds(SceneDescription& scene);

  /// The unit normal of the grounds, towards the objects; nullopt if there are no grounds.
  const std::optional<Vec3>& side() const { return side_; }
  /// Restores all grounds. The scene's shapes and instances must be those that the constructor left.
  void put_back(SceneDescription& scene);

 private:
  // Positions in the scene's vectors, ascending.
  std::vector<std::pair<std::size_t, description::Shape>> shapes_;
  std::vector<std::pair<std::size_t, description::Instance>> instances_;
  std::optional<Vec3> side_;
};

}  // namespace lanthorn
