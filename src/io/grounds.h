// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Grounds and backdrops, which are far larger than the things on them.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "lanthorn/scene_description.h"

namespace lanthorn {

/// Takes grounds out of a scene, so that a view can frame what stands on them. A ground is a mesh that is flat along an
/// axis of the world, along which the whole scene is flat, too, and whose bounding box is at least four times as large
/// as that of all meshes but the grounds: in a view of everything, these would be small. All grounds of a scene are on
/// the same side of the other meshes.
class Grounds {
 public:
  explicit Grounds(SceneDescription& scene);

  /// The unit normal of the grounds on the side where the things are; nullopt if there are no grounds.
  const std::optional<Vec3>& side() const { return side_; }
  /// Puts all of them back to their places. The scene's shapes and instances must be those that the constructor left.
  void put_back(SceneDescription& scene);

 private:
  // By their places, in ascending order.
  std::vector<std::pair<std::size_t, description::Shape>> shapes_;
  std::vector<std::pair<std::size_t, description::Instance>> instances_;
  std::optional<Vec3> side_;
};

}  // namespace lanthorn
