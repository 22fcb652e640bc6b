// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A photon meets a vertex: whether it belongs to the surface there, and how much of its light the vertex scatters.
// Shared by all photon methods. Photons have the interface of `PhotonMap::Ref`, which decodes each member on request.
#pragma once

#include <cmath>
#include <optional>

#include "math/lanes.h"
#include "path/vertex.h"
#include "photon/gather/kernels.h"
#include "photon/incidence.h"
#include "photon/photon.h"
#include "surface/bsdf.h"

namespace lanthorn {

/// Height / radius of photons that are in the plane of a gather point, however short their flights.
inline constexpr float plane_flatness = 1e-3f;

/// True if a photon within `reach` (m) of a gather point is on the point's surface: it is near the tangent plane, and
/// it has not set out behind that plane, as seen from the side that it would light. Otherwise it is between this
/// surface and one close to it, and its light cannot have come here. `height` (m): of the photon over the plane.
/// `cosine`: between its direction and the plane's normal. `flight` (m): at most the length of its last flight.
inline bool is_on_surface(float height, float cosine, float flight, float reach) {
  const float in_plane = plane_flatness * reach, lit_height = cosine > 0 ? height : -height;
  const bool set_out_behind = lit_height < -in_plane && lit_height + flight * std::fabs(cosine) <= in_plane;
  return is_in_disc(height, reach) && !set_out_behind;
}
/// `is_on_surface` for one photon at several gather points.
inline LaneMask are_on_surface(const Lanes& height, const Lanes& cosine, float flight, float reach) {
  const float in_plane = plane_flatness * reach;
  const Lanes lit_height = select(0.0f < cosine, height, 0.0f - height);
  const LaneMask set_out_behind = (lit_height < -in_plane) & (lit_height + flight * abs(cosine) <= in_plane);
  return (abs(height) <= search_flatness * reach) & ~set_out_behind;
}

/// The same for a photon and a point whose surface has the normal `normal`.
template <class Photon>
bool lies_on(const Photon& photon, const Point& p, const Normal& normal, float reach) {
  const float height = dot(photon.position() - p, normal);
  return is_in_disc(height, reach) && is_on_surface(height, dot(photon.wi(), normal), photon.flight(), reach);
}

/// Least |cosine| between the normals of one surface, whose parts may face either way.
inline constexpr float one_surface_cosine = 0.5f;
/// True unless the photon is known to lie on a surface of another normal.
template <class Photon>
bool may_have_normal(const Photon& photon, const Normal& normal) {
  const std::optional<Normal> own = photon.normal();
  return !own || std::fabs(dot(*own, normal)) >= one_surface_cosine;
}

/// Scattering of a photon at a vertex. The density estimate is L = Σ K f Φ |cos_s| / |cos_g| (Jensen 2001, eq. 7.6,
/// with shading normals as in incidence.h); each summand is K f Φ `ratio`. (DiffuseBundle in reverse_photons.cpp
/// computes the same for several points at once.)
struct PhotonHit : BsdfValue {  ///< towards the eye, from the photon's previous vertex; reverse pdf only where said
  float ratio;                  ///< of the shading cosine to the geometric cosine (incidence_ratio)
};

/// A vertex of an eye path, as photons meet it. Keeps a reference to the vertex.
class GatherVertex {
 public:
  explicit GatherVertex(const SurfaceVertex& vertex)
      : vertex_(vertex), is_dispersed_(vertex.state.dispersed || is_dispersive(vertex.at.bsdf)) {}
  explicit GatherVertex(SurfaceVertex&&) = delete;

  const SurfaceVertex& vertex() const { return vertex_; }

  /// False if the light path and the eye path together would have too many scatterings.
  bool admits(const PhotonFlags& flags) const { return flags.eye_scatterings >= vertex_.state.scatterings() - 1; }
  /// Whether the light that a photon brings is dispersed. `photon`: whether the photon's own path is.
  bool is_dispersed(bool photon) const { return is_dispersed_ || photon; }

  /// Empty if the surface scatters none of a photon's light to the eye. `wi` is the direction to the photon's previous
  /// vertex, world space. `both_densities`: also computes the density of the reverse direction.
  template <bool both_densities = false>
  std::optional<PhotonHit> scatter(const Direction& wi) const {
    std::optional<PhotonHit> result;
    const SurfacePoint& at = vertex_.at;
    if (is_behind(at, vertex_.wi, wi)) return result;  // light for `offset_origin`, which no photon brings
    const Vec3 wo_local = at.shading.to_local(wi);
    const BsdfValue value = evaluate(at.bsdf, vertex_.wi_local, wo_local, Transport::radiance,
                                     {.f = true, .pdf = true, .pdf_reverse = both_densities});
    if (value.f.is_black()) return result;
    PhotonHit& hit = result.emplace();
    static_cast<BsdfValue&>(hit) = value;
    hit.ratio = incidence_ratio(cosine(at.bsdf, wo_local), geometric_cosine(at, wi));
    return result;
  }

  /// How the photon, within `reach` (m), lights the vertex: empty if it is not on the surface, if the path would be too
  /// long, or if nothing is scattered to the eye.
  template <bool both_densities = false, class Photon>
  std::optional<PhotonHit> meet(const Photon& photon, float reach) const {
    const SurfacePoint& at = vertex_.at;
    const float height = dot(photon.position() - at.position, at.normal);
    if (!is_in_disc(height, reach) || !admits(photon.flags())) return {};
    const Direction wi = photon.wi();  // decoded once
    if (!is_on_surface(height, dot(wi, at.normal), photon.flight(), reach)) return {};
    return scatter<both_densities>(wi);
  }

 private:
  const SurfaceVertex& vertex_;
  bool is_dispersed_;
};

}  // namespace lanthorn
