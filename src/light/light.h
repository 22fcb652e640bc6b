// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Sources of light: a closed set of plain structs, each in a file of its own, joined into the variant `Light`. A mesh
// that emits is one AreaLight per triangle or patch. All functions are pure; lights are immutable once the scene is
// built.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "light/area_light.h"
#include "light/distant_light.h"
#include "light/goniometric_light.h"
#include "light/infinite_light.h"
#include "light/point_light.h"
#include "light/portal_light.h"
#include "light/projection_light.h"
#include "light/sample.h"
#include "light/spot_light.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

using Light = std::variant<AreaLight, PointLight, SpotLight, GoniometricLight, ProjectionLight, DistantLight,
                           UniformInfiniteLight, ImageInfiniteLight, PortalLight>;

/// A direction from `from` towards the light for next-event estimation. Empty if no light can arrive (behind a
/// one-sided emitter, outside a spot's cone, pdf 0). Visibility is the caller's.
std::optional<LightSample> sample_direct(const Light& light, const Point& from, const Vec2& u, const Wavelengths& w);

/// Density, per solid angle at `from`, with which `sample_direct` draws the direction that hit the emitter's surface at
/// `hit`. 0 for lights that rays cannot hit.
float pdf_direct(const Light& light, const Point& from, const EmitterHit& hit);
/// The same for infinite lights and a direction in which a ray from `from` left the scene.
float pdf_direct_infinite(const Light& light, const Point& from, const Direction& towards);

/// Radiance that the emitter's surface sends from `hit` in `direction`, which points away from the surface.
Spectrum emitted(const Light& light, const EmitterHit& hit, const Direction& direction, const Wavelengths& w);
/// Radiance of an infinite light seen from `from` in direction `towards`.
Spectrum emitted_infinite(const Light& light, const Point& from, const Direction& towards, const Wavelengths& w);

/// A ray that carries one photon away. The photon's flux (for one photon of this light) is in the sample.
std::optional<EmissionSample> sample_emission(const Light& light, const Vec2& u_position, const Vec2& u_direction,
                                              const Wavelengths& w);
/// Densities of `sample_emission` for a given ray (for MIS) from `origin`, of which lights without surface need
/// at most the position.
EmissionPdf pdf_emission(const Light& light, const EmitterHit& origin, const Direction& direction);

/// Total emitted power in watts, as luminance (RGB mode's luminance of the light's colour times the geometric factor):
/// what photons are shared out by. Infinite and distant lights: through the disk that covers the scene's bounding
/// sphere.
float power(const Light& light);
/// True if rays can never hit it, or its direction or position is a single one (point, spot, distant).
bool is_delta(const Light& light);
/// True if rays that leave the scene see it.
bool is_infinite(const Light& light);

}  // namespace lanthorn
