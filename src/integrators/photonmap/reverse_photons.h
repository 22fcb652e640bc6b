// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reverse photons (Havran, Herzog & Seidel 2005, "Fast Final Gathering via Reverse Photon Mapping"): the points at
// which eye paths need the photons' light are stored, and photons add their light to them. Also the
// radii of the photons.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "film/film.h"
#include "index/bucket_kdtree.h"
#include "path/vertex.h"
#include "photon/gather/kernels.h"
#include "photon/gather/radiance_estimate.h"
#include "photon/photon.h"
#include "photon/photon_map.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Decomposition of the light at the first visible surface (Jensen 1996): A, direct light; B, light reflected by
/// mirrors, glass and narrow lobes; C, caustics; D, other indirect light. Their sum with `emission` is all light.
enum class Term : std::uint8_t { direct, specular, caustic, diffuse };

/// A stored point that photons add light to.
struct ReversePhoton {
  WalkState state;
  SurfacePoint at;
  Direction wi;
  Vec3 wi_local;
  MapShare share;
  Term term;
  Wavelengths w;     ///< of the eye path
  Spectrum light{};  ///< radiance from photons towards the eye, times the eye path's beta

  SurfaceVertex vertex() const { return {state, at, wi, wi_local, true}; }
};

/// A reverse photon on a purely diffuse surface: smaller, and processed eight at a time.
struct DiffuseReversePhoton {
  Spectrum light;     ///< first radiance / irradiance, 1/sr, times the eye path's beta; after the photons, radiance
  Point position;     ///< m
  Normal normal;      ///< geometric
  Normal eye_normal;  ///< of shading, on the side of the eye
  int scatterings;    ///< of the eye path before this point
  Term term;
};

/// The reverse photons of a pixel.
class ReversePhotons {
 public:
  /// `split` leaves a part of the vertex's light to the map. `w`: of the eye path.
  void add(const SurfaceVertex& vertex, const Wavelengths& w, const LobeSplit& split, Term term);

  /// Calls `visit(term, light)` for each: diffuse ones first, each group in the order of the eye path.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (const DiffuseReversePhoton& r : diffuse) visit(r.term, r.light);
    for (const ReversePhoton& r : others) visit(r.term, r.light);
  }

  std::vector<DiffuseReversePhoton> diffuse;
  std::vector<ReversePhoton> others;
};

/// Source of a photon's radius: the distance to its k-th neighbour, or the diagonal and the number of photons of its
/// leaf in the kd-tree, which needs no search (Havran et al. 2005).
enum class RadiusRule : std::uint8_t { nearest, leaf };

/// Kernel radius (m) of each photon, by slot, where photons look for points instead of points for photons. By the given
/// rule the disc holds `settings.nearest` photons; the radius is at most `settings.radius`. If `nearest` is 0, every
/// radius is the support of the kernel whose equivalent box kernel has radius `settings.radius`.
std::vector<float> photon_radii(const PhotonMap<BucketKdTree>& map, const EstimateSettings& settings, RadiusRule rule);

/// A photon with its kernel radius, decoded once for all points within the radius.
struct InfluencePhoton {
  Spectrum flux;  ///< W, times grazing_gain
  Point place;
  float radius;  ///< of the kernel's support, m
  Direction incident;
  Normal surface_normal;  ///< 0 if unknown
  PhotonFlags path_flags;
  float last_flight;  ///< m

  // The interface of `PhotonMap::Ref`.
  Point position() const { return place; }
  Direction wi() const { return incident; }
  Spectrum power() const { return flux; }
  std::optional<Normal> normal() const {
    return surface_normal == Normal(0) ? std::optional<Normal>() : surface_normal;
  }
  PhotonFlags flags() const { return path_flags; }
  float flight() const { return last_flight; }
};

/// The photons of a map with their discs, in the order of the map's slots, so that consecutive photons are neighbours.
struct InfluencePhotons {
  std::vector<InfluencePhoton> photons;
  std::vector<Ball> reaches;

  /// `radii` are indexed by slot (`photon_radii`).
  static InfluencePhotons of(const PhotonMap<BucketKdTree>& map, std::span<const float> radii);
  std::size_t memory_bytes() const { return photons.size() * sizeof(InfluencePhoton) + reaches.size() * sizeof(Ball); }
};

/// Largest memory of one reverse photon in bytes, including its share of the index during construction.
inline constexpr std::size_t reverse_photon_bytes =
    sizeof(ReversePhoton) + sizeof(void*) + 2 * sizeof(Point) + sizeof(NumberedPoint) + sizeof(std::uint32_t);

/// Adds to all reverse photons of the pixels the light of the photons around them. Each sum is in the order of the
/// photons, so that it depends neither on the number of threads nor on the division into blocks.
void distribute(const InfluencePhotons& photons, const Kernel& kernel, const Wavelengths& w,
                std::span<ReversePhotons> pixels);

}  // namespace lanthorn
