// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The medium around a point, as the scene's shapes say. Lights and cameras use it, whatever their own MediumInterface
// says, so that light paths, eye paths and connections pass through the same media. media_check.cpp warns where shapes
// contradict each other.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "camera/view.h"
#include "scene/scene.h"

namespace lanthorn {

struct LightPart;

/// True for interfaces of media and for closures that transmit: behind them, rays are in the medium declared there.
bool lets_through(const SurfacePoint& at);

/// The name of the medium in warnings.
std::string name_of_medium(const Scene& scene, MediumId id);

/// Finds media around points.
class MediumFinder {
 public:
  explicit MediumFinder(const Scene& scene);

  /// The medium around the point, if all rays from it towards the shapes that bound media find the same one: the medium
  /// on the near side of the first interface or clear surface. Nullopt if rays meet none, or if shapes contradict each
  /// other.
  std::optional<MediumId> around(const Point& p, float time) const;

 private:
  const Scene& scene_;
  std::vector<Bounds> targets_;
};

/// Sets the media of the described lights: for point-like lights the medium around them, otherwise the declared one.
/// Warns where a declaration is wrong. `lights`: of the scene, while it is built.
void settle_light_media(const Scene& scene, LightPart& lights);

/// The view in this scene. Its medium is the one around the camera if that is known, otherwise the declared one. Throws
/// Error like `make_view`.
View view_in(const Scene& scene, const ViewDescription& description, const ViewOptions& options = {});

/// Warns of contradictory media: rays that travel in one medium and arrive where the scene declares another. The result
/// for such rays depends on their path, so integrators disagree. Follows straight rays through glass and interfaces,
/// from the camera, and from the surfaces that it sees on to the lights. Among lights, only surfaces may lack the
/// medium around them (for other lights see `settle_light_media`). Media that opaque surfaces declare do not count,
/// because rays stay in their own medium there; nor do a few rays that slip between touching shapes. One warning for
/// each kind, at its location in the scene file.
std::vector<description::Warning> media_warnings(const Scene& scene, const View& view);

}  // namespace lanthorn
