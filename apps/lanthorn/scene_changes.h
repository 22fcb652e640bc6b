// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Changes of a scene from the command line or from the page of `serve`: camera position, lens and brightness of each
// light. Both produce the same picture from the same changes.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "options.h"

namespace lanthorn::program {

// Position around what the camera looks at, and lens (lens.cpp).

/// Rotation around what the camera looks at, in degrees: to the right in the picture, and upwards.
struct Orbit {
  float yaw = 0, pitch = 0;
  friend bool operator==(const Orbit&, const Orbit&) = default;
};

struct LensChanges {
  using Aperture = std::optional<float>;  ///< f-number; nullopt: a pinhole
  using Focus = std::optional<float>;     ///< metres; nullopt: the surface at the centre of the picture
  std::optional<Orbit> orbit{};
  std::optional<float> fov{};  ///< degrees over the shorter side of the picture
  std::optional<Aperture> aperture{};
  std::optional<Focus> focus{};
  friend bool operator==(const LensChanges&, const LensChanges&) = default;
};
ValueType<float> fov_type();
ValueType<LensChanges::Aperture> aperture_type();
ValueType<LensChanges::Focus> focus_type();

/// --orbit, --fov, --aperture and --focus.
OptionTable lens_options(LensChanges& lens);

/// The world's up axis is +y or +z, whichever is nearer to the camera's up vector. The camera turns around the point of
/// its axis that is nearest to the centre of the scene. A camera that frames a subject frames it from the new
/// direction. Throws Error for cameras that do not support the change.
void change_lens(ViewDescription& view, const LensChanges& lens, const Scene& scene, const ViewOptions& options);

/// Lens parameters of a view; empty where the camera has no such parameter.
struct LensNumbers {
  std::optional<float> fov{};       ///< degrees; nullopt: the camera is not perspective
  std::optional<float> aperture{};  ///< f-number; nullopt: a pinhole, or not perspective
  std::optional<float> focus{};     ///< metres; nullopt: everything is in focus
};
LensNumbers lens_of(const ViewDescription& view);
/// Distance, in metres along the camera's axis, of the surface in a pixel of the whole picture. Throws Error if the
/// pixel sees no surface.
float focus_at(const ViewDescription& view, const Scene& scene, const ViewOptions& options, const Vec2& pixel);

/// The view from `count` positions at equal distance and equal angles around what the camera looks at, starting with
/// the view itself and turning to the right.
std::vector<ViewDescription> turntable(const ViewDescription& view, const Scene& scene, std::size_t count);
/// Applies --focus again after `turntable`.
void focus(ViewDescription& view, const LensChanges& lens, const Scene& scene, const ViewOptions& options);

// Place of the camera, and lights (scene_changes.cpp).

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
