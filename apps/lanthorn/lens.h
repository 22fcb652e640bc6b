// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Changes of a scene's camera from the command line: its position around what it looks at, and its lens.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "lanthorn/scene.h"
#include "options.h"

namespace lanthorn::program {

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

}  // namespace lanthorn::program
