// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The photon-against-hit term of all photon methods, and the decision where to use it.
#pragma once

#include <cmath>

#include "path/direct_light.h"
#include "path/vertex.h"
#include "photon/kernels.h"
#include "photon/photon_hit.h"
#include "photon/photon_map.h"
#include "spectrum/wavelengths.h"
#include "surface/bsdf.h"

namespace lanthorn {

/// Probability with which an eye vertex takes its indirect light from photons instead of continuing the path: 1 for
/// diffuse, 0 for mirrors and clear glass, and in between smooth in the lobes' width. A lobe of GGX width alpha counts
/// alpha² / (alpha² + 0.1²): photons within the solid angle of a lobe grow in number like alpha², so that the variance
/// of the gathered light stays bounded as alpha goes to 0.
inline float gather_probability(const LobeWeights& lobes) {
  constexpr float half_width = 0.1f;  // GGX width at which both estimates are about equally noisy
  const float total = lobes.diffuse + lobes.glossy + lobes.delta;
  if (!(total > 0)) return 1;
  const float wide = sqr(lobes.alpha) / (sqr(lobes.alpha) + sqr(half_width));
  return std::fmin(1.0f, (lobes.diffuse + lobes.glossy * wide) / total);
}

/// Light that photons bring to an eye vertex, times the vertex's beta, in the two classes that photons can be of.
struct GatheredLight {
  Spectrum caustic;  ///< came from the light by delta scatterings alone; no other technique need find it
  Spectrum indirect;
};

/// What a gather needs besides the photons.
struct GatherSettings {
  Kernel kernel;
  float radius = 0;              ///< of the box kernel that the kernel stands in for, metres
  float delta_light_weight = 1;  ///< factor of photons that came from a delta light by delta scatterings alone: the
                                 ///< walk can never find their light, so they stand for all of it
};

/// A photon that a gather has met.
struct MetPhoton {
  Vec3 offset;     ///< m, of the photon from the gather point, world space
  float dist2;     ///< m², its squared length
  Spectrum light;  ///< W/sr: what it reflects towards the eye, to be weighted by a density (1/m²)
};

/// Density estimate of reflected radiance (Jensen 2001, eq. 7.6) with the photons on the vertex's surface: those whose
/// distance from the tangent plane is small against the radius. Photons carry flux per emitted photon, so that nothing
/// is left to divide by. `see(MetPhoton)` is told of each photon within `reach` >= the kernel's support, m.
template <class Map, class See>
GatheredLight gather_photons(const Map& map, const SurfaceVertex& vertex, const GatherSettings& settings,
                             const Wavelengths& w, float reach, See&& see) {
  const SurfacePoint& at = vertex.at;
  const float support = settings.kernel.support(settings.radius), support2 = support * support;
  const int eye_scatterings = vertex.state.depth - 1;
  const bool eye_dispersed = vertex.state.dispersed || is_dispersive(at.bsdf);
  GatheredLight sum;
  map.for_each_near(at.position, reach, [&](const auto& photon, float dist2) {
    const Vec3 offset = photon.position() - at.position;
    const float height = std::fabs(dot(offset, at.normal));
    if (height > search_flatness * reach) return;
    const PhotonFlags flags = photon.flags();
    if (flags.eye_scatterings < eye_scatterings) return;
    const std::optional<PhotonHit> hit = hit_by_photon(vertex, photon.wi());
    if (!hit) return;
    Spectrum light = hit->f * photon.power() * hit->ratio;
    see(MetPhoton{offset, dist2, light});
    if (dist2 > support2 || height > search_flatness * support) return;
    light *= settings.kernel.weight(dist2, support2);
    if (eye_dispersed || flags.dispersed) light *= w.dispersed;
    if (flags.caustic)
      sum.caustic += flags.from_delta_light ? light * settings.delta_light_weight : light;
    else
      sum.indirect += light;
  });
  sum.caustic *= vertex.state.beta;
  sum.indirect *= vertex.state.beta;
  return sum;
}

/// The same for those who only want the light.
template <class Map>
GatheredLight gather_photons(const Map& map, const SurfaceVertex& vertex, const GatherSettings& settings,
                             const Wavelengths& w) {
  return gather_photons(map, vertex, settings, w, settings.kernel.support(settings.radius), [](const MetPhoton&) {});
}

}  // namespace lanthorn
