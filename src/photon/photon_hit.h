// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The contribution of one photon at a hit point, for all photon methods.
#pragma once

#include <optional>

#include "path/vertex.h"
#include "photon/incidence.h"
#include "surface/bsdf.h"

namespace lanthorn {

/// Scattering of a photon at a hit point. The density estimate is L = Σ K f Φ |cos_s| / |cos_g| (Jensen 2001, eq. 7.6,
/// with shading normals as in incidence.h); each summand is K f Φ `ratio`. (DiffuseBundle in reverse_photons.cpp
/// computes the same for several points at once.)
struct PhotonHit : BsdfValues {  ///< towards the eye, from the photon's previous vertex; reverse pdf only where said
  float ratio;                   ///< of the shading cosine to the geometric cosine (incidence_ratio)
};

/// True if a photon so far off the tangent plane may have landed on another surface than the vertex, although it is
/// within `reach` (both metres). Surfaces of one plane belong together, whichever way they face.
inline bool is_off_plane(float height, float reach) { return height > 1e-3f * reach; }
/// True if a photon off the plane has landed on another surface than the vertex: one that faces the other way, such as
/// the far wall of a thin shell, from inside. `from_outside`: it came from the side of its own surface's normal. For
/// records that have no room for more.
inline bool is_turned_away(const SurfacePoint& at, const Direction& wi, bool from_outside) {
  return at.is_oriented && (dot(at.normal, wi) > 0) != from_outside;
}

/// True if the light of a photon off the plane cannot have come to the vertex, because it set out behind the vertex's
/// tangent plane, as seen from the side that it would light: it is between this surface and one close to it.
inline bool comes_from_behind(const SurfacePoint& at, const Point& origin, const Direction& wi, float reach) {
  const float height = dot(origin - at.position, at.normal);
  return !is_off_plane(dot(wi, at.normal) > 0 ? height : -height, reach);
}

/// Empty if the surface scatters none of the photon's light to the eye. `wi` is the direction to the photon's previous
/// vertex, world space. `both_densities`: with that of the reverse direction.
template <bool both_densities = false>
std::optional<PhotonHit> hit_by_photon(const SurfaceVertex& vertex, const Direction& wi) {
  const SurfacePoint& at = vertex.at;
  const Vec3 wo_local = at.shading.to_local(wi);
  BsdfValues value;
  if constexpr (both_densities)
    value = eval_and_pdfs(at.bsdf, vertex.wi_local, wo_local, Transport::radiance);
  else
    value = {eval_and_pdf(at.bsdf, vertex.wi_local, wo_local, Transport::radiance)};
  if (value.f.is_black()) return {};
  return PhotonHit{value, incidence_ratio(cosine(at.bsdf, wo_local), geometric_cosine(at, wi))};
}

}  // namespace lanthorn
