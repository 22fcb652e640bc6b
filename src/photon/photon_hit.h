// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The contribution of one photon at a hit point, for all photon methods.
#pragma once

#include <cmath>
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

/// Height / reach of photons that are in the plane of a gather point.
inline constexpr float plane_flatness = 1e-3f;

/// True if the light of a photon within `reach` (m) cannot have come to a gather point, because it set out behind the
/// point's tangent plane, as seen from the side that it would light: it is between this surface and one close to it.
/// `height` (m) is the photon's over the plane, `cosine` that of its direction to the plane's normal; `flight` (m) is
/// at most the length of its last flight. Photons in the plane belong to the surface, however short their flights.
inline bool comes_from_behind(float height, float cosine, float flight, float reach) {
  const float in_plane = plane_flatness * reach, lit_height = cosine > 0 ? height : -height;
  return lit_height < -in_plane && lit_height + flight * std::fabs(cosine) <= in_plane;
}

/// Empty if the surface scatters none of the photon's light to the eye. `wi` is the direction to the photon's previous
/// vertex, world space. `both_densities`: with that of the reverse direction.
template <bool both_densities = false>
std::optional<PhotonHit> hit_by_photon(const SurfaceVertex& vertex, const Direction& wi) {
  std::optional<PhotonHit> result;
  const SurfacePoint& at = vertex.at;
  const Vec3 wo_local = at.shading.to_local(wi);
  BsdfValues value;
  if constexpr (both_densities)
    value = eval_and_pdfs(at.bsdf, vertex.wi_local, wo_local, Transport::radiance);
  else
    value = {eval_and_pdf(at.bsdf, vertex.wi_local, wo_local, Transport::radiance)};
  if (value.f.is_black()) return result;
  PhotonHit& hit = result.emplace();
  static_cast<BsdfValues&>(hit) = value;
  hit.ratio = incidence_ratio(cosine(at.bsdf, wo_local), geometric_cosine(at, wi));
  return result;
}

}  // namespace lanthorn
