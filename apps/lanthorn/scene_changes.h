// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Changes of a scene from the command line or from the page of `serve`: camera position and brightness of each light.
// Both produce the same picture from the same changes.
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

/// Throws Error unless the numbers define a position, a viewing direction and an up direction.
void check(const LookAt& look);

/// The LookAt of a view: from its camera's position when the shutter opens to a point `distance` in front of it.
/// `origin`: that of the scene (`SceneDescription::origin`).
LookAt look_of(const ViewDescription& view, const ViewOptions& options, float distance, const DVec3& origin);
/// Moves the camera. Its lens and the mirroring and scale of its transform stay; animation and framing of a subject
/// end.
void place_camera(ViewDescription& view, const LookAt& look, const DVec3& origin);

/// Brightness factors by the names of lights; missing: 1.
using LightFactors = std::map<std::string, float>;

/// NAME=FACTOR.
ValueType<std::pair<std::string, float>> light_factor_type();
/// The scene with its lights multiplied. Equal factors give scenes with equal identity, whose states can be merged.
/// Throws Error for names that are not among `lights_of`.
SharedScene scale_lights(const SharedScene& scene, const LightFactors& factors);

/// Values of the options --look-at and --light and of the lens options.
struct SceneChanges {
  std::optional<LookAt> look{};
  LightFactors lights{};
  LensChanges lens{};
};
/// Places the camera and drops its orbit.
void move_camera(SceneChanges& changes, const LookAt& look);
/// The scene's own view with the camera of `changes`. A camera that was placed does not orbit.
ViewDescription view_of(const Scene& scene, const SceneChanges& changes, const ViewOptions& options = {});
/// Replaces the camera and the lights in `changes` and keeps the lens. If `look` is given, the orbit is dropped.
SceneChanges moved(SceneChanges changes, const std::optional<LookAt>& look, LightFactors lights);
/// --look-at, --light and the lens options.
OptionTable scene_change_options(SceneChanges& changes);

}  // namespace lanthorn::program
