// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Changes of a scene from the command line or from the page of `serve`: where the camera stands, and how bright each
// light is. Both make the same picture of the same changes.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "lens.h"
#include "options.h"

namespace lanthorn::program {

/// Throws Error unless the numbers are a place, a direction of view and an upward direction.
void check(const LookAt& look);

/// How a view looks: from its camera's place when the shutter opens to a point `distance` before it. `origin`: the
/// scene's (`SceneDescription::origin`).
LookAt look_of(const ViewDescription& view, const ViewOptions& options, float distance, const DVec3& origin);
/// Moves the camera. Its lens and the mirroring and scale of its transformation stay; it no longer moves or frames a
/// subject by itself.
void place_camera(ViewDescription& view, const LookAt& look, const DVec3& origin);

/// Factors of brightness by the names of lights; missing: 1.
using LightFactors = std::map<std::string, float>;

/// NAME=FACTOR.
ValueType<std::pair<std::string, float>> light_factor_type();
/// The scene with its lights multiplied. Equal factors give equal scenes, whose states belong together. Throws Error
/// for names that are not among `lights_of`.
SharedScene scale_lights(const SharedScene& scene, const LightFactors& factors);

/// What the options --look-at and --light say, and those of the lens.
struct SceneChanges {
  std::optional<LookAt> look{};
  LightFactors lights{};
  LensChanges lens{};
};
/// Places the camera, which then no longer orbits.
void move_camera(SceneChanges& changes, const LookAt& look);
/// The scene's own view with the camera of `changes`. A camera that has moved does not orbit.
ViewDescription view_of(const Scene& scene, const SceneChanges& changes, const ViewOptions& options = {});
/// Replaces the camera and the lights in `changes` and keeps the lens. With a given camera, the orbit is dropped.
SceneChanges moved(SceneChanges changes, const std::optional<LookAt>& look, LightFactors lights);
/// --look-at, --light and those of the lens.
OptionTable scene_change_options(SceneChanges& changes);

}  // namespace lanthorn::program
