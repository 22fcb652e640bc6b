// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What the command line changes of a scene's camera: where it stands around what it looks at, and its lens.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "lanthorn/scene.h"
#include "options.h"

namespace lanthorn::program {

/// Degrees around what the camera looks at: to the right in the picture, and upwards.
struct Orbit {
  float yaw = 0, pitch = 0;
  friend bool operator==(const Orbit&, const Orbit&) = default;
};

struct LensChanges {
  using Aperture = std::optional<float>;  ///< f-number; none: a pinhole
  using Focus = std::optional<float>;     ///< metres; none: what the middle of the picture sees
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

/// The axis, +y or +z, to which the camera's direction upwards is nearer, is upwards in the world. The camera turns
/// around the point of its axis that is nearest to the middle of the scene. One that frames a subject frames it from
/// there. Throws Error for cameras that cannot be changed so.
void change_lens(ViewDescription& view, const LensChanges& lens, const Scene& scene, const ViewOptions& options);

/// The numbers of a view's lens. Cameras that have no such number leave it empty.
struct LensNumbers {
  std::optional<float> fov{};       ///< degrees; none: the camera is not perspective
  std::optional<float> aperture{};  ///< f-number; none: a pinhole, or not perspective
  std::optional<float> focus{};     ///< metres; none: all is sharp
};
LensNumbers lens_of(const ViewDescription& view);
/// How far away the surface in a pixel of the whole picture is, m, along the camera's axis. Throws Error if
/// there is none.
float focus_at(const ViewDescription& view, const Scene& scene, const ViewOptions& options, const Vec2& pixel);

/// The view from so many places in equal steps around what the camera looks at, from the view itself to the right. All
/// are equally far away.
std::vector<ViewDescription> turntable(const ViewDescription& view, const Scene& scene, std::size_t count);
/// Focuses again: after `turntable`.
void focus(ViewDescription& view, const LensChanges& lens, const Scene& scene, const ViewOptions& options);

}  // namespace lanthorn::program
