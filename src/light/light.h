// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Light sources: a closed set of plain structs, each in its own file, joined into the variant `Light`. An emitting mesh
// is one AreaLight per triangle or patch. All functions are pure; lights are immutable once the scene is built.
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

/// Samples a direction from `from` towards the light for next-event estimation. Returns nullopt if no light can arrive
/// (behind a one-sided emitter, outside a spot's cone, pdf 0). The caller tests visibility.
std::optional<LightSample> sample_direct(const Light& light, const Point& from, const Vec2& u, const Wavelengths& w);

/// Density, per solid angle at `from`, with which `sample_direct` samples the direction that hits the emitter's surface
/// at `hit`. 0 for lights that rays cannot hit.
float pdf_direct(const Light& light, const Point& from, const EmitterHit& hit);
/// Density of `sample_direct` for infinite lights, for a direction in which a ray from `from` left the scene.
float pdf_direct_infinite(const Light& light, const Point& from, const Direction& towards);

/// Radiance emitted at `hit` in `direction`, which points away from the surface.
Spectrum emitted(const Light& light, const EmitterHit& hit, const Direction& direction, const Wavelengths& w);
/// Radiance of an infinite light seen from `from` in the direction `towards`.
Spectrum emitted_infinite(const Light& light, const Point& from, const Direction& towards, const Wavelengths& w);

/// Samples a ray that carries one photon away. The sample includes the photon's flux (for one emitted photon of this
/// light).
std::optional<EmissionSample> sample_emission(const Light& light, const Vec2& u_position, const Vec2& u_direction,
                                              const Wavelengths& w);
/// Densities of `sample_emission` for a given ray (for MIS). `origin`: where the ray starts; lights without surface use
/// at most its position.
EmissionPdf pdf_emission(const Light& light, const EmitterHit& origin, const Direction& direction);

/// Total emitted power in watts, as luminance (luminance of the light's RGB-mode colour times the geometric factor).
/// Photons are distributed in proportion to it. Infinite and distant lights: power through the disk that covers the
/// scene's bounding sphere.
float power(const Light& light);
/// True if rays can never hit the light, or its direction or position is a single one (point, spot, distant).
bool is_delta(const Light& light);
/// True if rays that leave the scene see the light.
bool is_infinite(const Light& light);

}  // namespace lanthorn
