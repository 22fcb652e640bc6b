// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "light/sample.h"
#include "medium/medium.h"
#include "path/path_context.h"
#include "path/vertex.h"
#include "scene/scene.h"

namespace lanthorn {

/// Result of following light through media.
struct Passage {
  Spectrum transmittance;  ///< 0 if a surface occludes the light; in heterogeneous media an unbiased estimate
  MediumId medium = MediumId::vacuum;  ///< at the end of the ray
  float optical_depth = 0;             ///< as in `Attenuation`
};
// `dimensions`: the group of the sampler that seeds the random numbers of flights through media.

/// Whether a ray in `direction` may leave the vertex. Only where it would start on the smooth surface over a facet
/// (`offset_origin`) can it be false: if another surface lies between, or if the ray would arrive at the back of the
/// surface at its end.
inline bool may_leave(const PathContext& path, const SurfaceVertex& v, const Direction& direction,
                      const SegmentEnd& end = {}) {
  if (!leaves_from_smooth_surface(v.at, direction)) return true;
  const Point start = offset_origin(v.at, direction);
  if (dot(start - end.position, end.normal) * dot(v.at.position - end.position, end.normal) < 0) return false;
  ++path.counts.shadow;
  return path.scene.visible(spawn_ray_to(v.at, -direction, {start}));
}
inline bool may_leave(const PathContext&, const MediumVertex&, const Direction&, const SegmentEnd& = {}) {
  return true;
}

/// Passage of light that travels from the ray's origin, which lies in `medium`, to its end.
Passage passage(const PathContext& path, const Ray& ray, MediumId medium, std::uint32_t dimensions);
/// The same for a ray that ends at the camera's lens: shapes that are hidden from the camera do not block it.
Passage passage_to_lens(const PathContext& path, const Ray& ray, MediumId medium, std::uint32_t dimensions);
/// Radiance that the medium `emissive` sends to the ray's origin, from all parts of the ray inside that medium. The
/// origin lies in `medium`; the ray is infinite.
Spectrum volume_emission(const PathContext& path, const Ray& ray, MediumId medium, MediumId emissive,
                         std::uint32_t dimensions);
/// Passage of a photon's light from infinity, where it starts in `medium`, to the photon's origin.
Passage passage_from_infinity(const PathContext& path, const EmissionSample& emission, MediumId medium, float time,
                              std::uint32_t dimensions);

}  // namespace lanthorn
