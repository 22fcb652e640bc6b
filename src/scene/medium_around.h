// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The medium that the shapes of a scene say is around a point. Lights and cameras have that one, whatever their own
// MediumInterface says: light paths, eye paths and connections then go through the same media.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "camera/view.h"
#include "scene/scene.h"

namespace lanthorn {

/// True for interfaces of media and for closures that transmit: beyond, rays are in the medium that is claimed there.
bool lets_through(const SurfacePoint& at);

/// As warnings call it.
std::string name_of_medium(const Scene& scene, MediumId id);

/// Finds media around points.
class MediumFinder {
 public:
  explicit MediumFinder(const Scene& scene);

  /// The medium that all rays from the point towards shapes that bound media find there: by the side of the first
  /// interface or clear surface that they meet. Empty if they meet none, or if shapes contradict each other.
  std::optional<MediumId> around(const Point& p, float time) const;

 private:
  const Scene& scene_;
  std::vector<Bounds> targets_;
};

/// Sets the media of the described lights with these numbers: what is around those that are points, else what is
/// claimed. Warns where a claim is wrong.
void settle_light_media(const std::shared_ptr<SceneData>& data, std::span<const description::Index> lights);

/// The view in this scene: its medium is what is around the camera where this is known, else what is claimed. Throws
/// Error like `make_view`.
View view_in(const Scene& scene, const ViewDescription& description, const ViewOptions& options = {});

}  // namespace lanthorn
