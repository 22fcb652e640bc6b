// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reverse photons (Havran, Herzog & Seidel 2005, "Fast Final Gathering via Reverse Photon Mapping"): points where eye
// paths ask for the photons' light are kept, and photons bring it to them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "film/film.h"
#include "index/bucket_kdtree.h"
#include "path/vertex.h"
#include "photon/kernels.h"
#include "photon/photon.h"
#include "photon/photon_map.h"
#include "photon/radiance_estimate.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Parts of the light by what the surface that the camera sees does with it (Jensen 1996): A, direct light; B, light
/// that mirrors, glass and narrow lobes bring from elsewhere; C, caustics; D, other indirect light. With `emission`
/// they are all.
enum class Term : std::uint8_t { direct, specular, caustic, diffuse };

/// A point that waits for light.
struct ReversePhoton {
  WalkState state;
  SurfacePoint at;
  Direction wi;
  Vec3 wi_local;
  MapShare share;
  Term term;
  Spectrum light{};  ///< radiance that photons made it send to the eye, with the eye path's beta

  SurfaceVertex vertex() const { return {state, at, wi, wi_local, true}; }
};

/// The same on a surface that only scatters diffusely: less to keep, and photons meet eight at a time.
struct DiffuseReversePhoton {
  Spectrum light;  ///< first radiance by irradiance, 1/sr, with the eye path's beta; when photons have come, radiance
  Point position;  ///< m
  Normal normal;   ///< geometric
  Normal eye_normal;  ///< of shading, on the side of the eye
  int scatterings;    ///< of the eye path before this point
  Term term;
};

/// Those of a pixel.
class ReversePhotons {
 public:
  /// `p`: probability with which the eye path reads the map here.
  void add(const SurfaceVertex& vertex, float p, Term term);

  /// Calls `visit(term, light)` for each, in the order of the eye path as far as they are of one kind.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (const DiffuseReversePhoton& r : diffuse) visit(r.term, r.light);
    for (const ReversePhoton& r : others) visit(r.term, r.light);
  }

  std::vector<DiffuseReversePhoton> diffuse;
  std::vector<ReversePhoton> others;
};

/// A photon with the radius within which it brings light, decoded once for the many points that it meets.
struct InfluencePhoton {
  Spectrum flux;  ///< W, times grazing_gain
  Point place;
  float radius;  ///< of the kernel's support, m
  Direction incident;
  Normal surface_normal;  ///< 0 if not known
  PhotonFlags path_flags;

  // As of a `PhotonMap::Ref`.
  Point position() const { return place; }
  Direction wi() const { return incident; }
  Spectrum power() const { return flux; }
  std::optional<Normal> normal() const {
    return surface_normal == Normal(0) ? std::optional<Normal>() : surface_normal;
  }
  PhotonFlags flags() const { return path_flags; }
};

/// The photons of a map with the places that they reach, in the order of the map's slots: neighbours come together.
struct InfluencePhotons {
  std::vector<InfluencePhoton> photons;
  std::vector<Ball> reaches;

  /// `radii`: by slot (`photon_radii`).
  static InfluencePhotons of(const PhotonMap<BucketKdTree>& map, std::span<const float> radii);
  std::size_t memory_bytes() const { return photons.size() * sizeof(InfluencePhoton) + reaches.size() * sizeof(Ball); }
};

/// Most bytes that one reverse photon takes, with its part of the index while that is built.
inline constexpr std::size_t reverse_photon_bytes =
    sizeof(ReversePhoton) + sizeof(void*) + 2 * sizeof(Point) + sizeof(NumberedPoint) + sizeof(std::uint32_t);

/// Gives all reverse photons of the pixels the light of the photons that reach them. Their light's sums are in the
/// order of the photons, so that they depend neither on threads nor on which pixels are done together.
void distribute(const InfluencePhotons& photons, const Kernel& kernel, const Wavelengths& w,
                std::span<ReversePhotons> pixels);

}  // namespace lanthorn
