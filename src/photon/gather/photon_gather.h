// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Density estimation at eye vertices, and the part of the light that it estimates.
#pragma once

#include <algorithm>
#include <cmath>

#include "path/coherence.h"
#include "path/direct_light.h"
#include "path/vertex.h"
#include "photon/gather/kernels.h"
#include "photon/gather/photon_hit.h"
#include "photon/photon_map.h"
#include "spectrum/wavelengths.h"
#include "surface/bsdf.h"

namespace lanthorn {

/// Share of a closure's light that wide lobes scatter: 1 for diffuse lobes, 0 for delta lobes, and alpha² / (alpha² +
/// 0.1²) for a lobe of GGX width alpha. The number of photons within the solid angle of a lobe is proportional to
/// alpha².
inline float wide_share(const LobeWeights& lobes) {
  const float total = lobes.diffuse + lobes.glossy + lobes.delta;
  if (!(total > 0)) return 1;
  return std::min(1.0f, (lobes.diffuse + lobes.glossy * spread_of_lobe(lobes.alpha)) / total);
}
inline float wide_share(const SurfaceVertex& vertex) {
  return wide_share(lobe_weights(vertex.at.bsdf, vertex.wi_local));
}

/// Division of the indirect light at an eye vertex between photons and the walk.
inline LobeSplit split_lobes(const SurfaceVertex& vertex) {
  // Photon records cannot count more scatterings of the eye path; beyond, the walk alone finds the light.
  if (vertex.state.scatterings() > PhotonFlags::most_eye_scatterings + 1) return LobeSplit::all_narrow();
  const float share = wide_share(vertex);
  if (share == 1) return LobeSplit::all_wide();
  return share > 0 ? LobeSplit() : LobeSplit::all_narrow();
}

/// Light of photons at an eye vertex, times the vertex's beta, in the two path classes of photons.
struct GatheredLight {
  Spectrum caustic;  ///< of photons that have scattered by delta lobes only; no other technique has to find it
  Spectrum indirect;
  Spectrum bias;  ///< estimate of the expected error of both together

  GatheredLight& operator+=(const GatheredLight& other) {
    caustic += other.caustic;
    indirect += other.indirect;
    bias += other.bias;
    return *this;
  }
};

/// Settings of a gather.
struct GatherSettings {
  Kernel kernel;
  float radius = 0;  ///< of the equivalent box kernel, metres
  LobeSplit split = LobeSplit::all_wide();
};

/// A photon found by a gather.
struct MetPhoton {
  Vec3 offset;     ///< from the gather point to the photon, m, world space
  float dist2;     ///< squared length of the offset, m²
  Spectrum light;  ///< scattered towards the eye, W/sr; to be weighted by a density (1/m²)
};

/// Density estimate of reflected radiance (Jensen 2001, eq. 7.6) from the photons on the vertex's surface, that is,
/// those whose distance from the tangent plane is small against the radius, and which have not set out behind it. The
/// photons' powers are already divided by the number of emitted photons. A photon's contribution is multiplied by the
/// part of light that `settings.split` leaves to photons. Photons that came from a delta light by delta scatterings
/// alone count in full: no walk can find their light. Calls `see(MetPhoton)` for each photon within `reach` (m), which
/// is at least the kernel's support.
template <class Map, class See>
GatheredLight gather_photons(const Map& map, const SurfaceVertex& vertex, const GatherSettings& settings,
                             const Wavelengths& w, float reach, See&& see) {
  const SurfacePoint& at = vertex.at;
  const float support = settings.kernel.support(settings.radius), support2 = support * support;
  const GatherVertex gather(vertex);
  GatheredLight sum;
  map.for_each_near(at.position, reach, [&](const auto& photon, float dist2) {
    const std::optional<PhotonHit> hit = gather.meet(photon, reach);
    if (!hit) return;
    const PhotonFlags flags = photon.flags();
    const float part = flags.from_delta_light ? 1.0f : settings.split.wide(hit->pdf);
    Spectrum light = hit->f * photon.power() * (part * hit->ratio);
    const Vec3 offset = photon.position() - at.position;
    see(MetPhoton{offset, dist2, light});
    if (dist2 > support2 || !is_in_disc(dot(offset, at.normal), support)) return;
    light *= settings.kernel.weight(dist2, support2);
    if (gather.is_dispersed(flags.dispersed)) light *= w.dispersed;
    (flags.caustic ? sum.caustic : sum.indirect) += light;
    sum.bias += light * settings.kernel.bias_share(dist2 / support2);
  });
  for (Spectrum* light : {&sum.caustic, &sum.indirect, &sum.bias}) *light *= vertex.state.beta;
  return sum;
}

/// The same without an observer.
template <class Map>
GatheredLight gather_photons(const Map& map, const SurfaceVertex& vertex, const GatherSettings& settings,
                             const Wavelengths& w) {
  return gather_photons(map, vertex, settings, w, settings.kernel.support(settings.radius), [](const MetPhoton&) {});
}

}  // namespace lanthorn
