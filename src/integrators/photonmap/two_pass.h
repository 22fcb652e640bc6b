// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The second of photon mapping's two passes (Jensen 1996; 2001, chapter 9). Light at a surface is the sum of four
// terms: A, direct light by next-event estimation; B, what mirrors, glass and narrow lobes bring, by going on with the
// eye path; C, caustics, from a map of their own; D, all other indirect light, by final gathering: rays whose ends read
// the global map.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "index/bucket_kdtree.h"
#include "integrators/integrator.h"
#include "integrators/photonmap/irradiance_cache.h"
#include "integrators/photonmap/irradiance_photons.h"
#include "integrators/photonmap/reverse_photons.h"
#include "integrators/photonmap/shadow_photons.h"
#include "path/path_draw.h"
#include "path/path_visitor.h"
#include "photon/guide_photons.h"
#include "photon/photon_map.h"
#include "photon/radiance_estimate.h"

namespace lanthorn {

/// The photons of a pass.
struct TwoPassMaps {
  using Map = PhotonMap<BucketKdTree>;

  PathDraw draw;
  Map global;  ///< all photons
  Map caustic;
  std::optional<IrradiancePhotons> irradiance;  ///< of the global map
  std::optional<GuidePhotons> guides;           ///< of the light that final gathering looks for
  /// Irradiance that final gathering has found at some points, by the depth of their eye paths' vertices less 1; none
  /// if it is to be gathered everywhere.
  std::vector<IrradianceCache> gathered;
  std::optional<ShadowPhotons> shadows;  ///< if they may stand in for shadow rays
  PassReport report;
};

/// Instead of the picture, what the maps hold where it is looked up.
enum class Show : std::uint8_t { image, global, caustic, shadow, radius, density, records };

/// How final gathering is cached.
struct GatherCacheSettings {
  float error = 0;            ///< Ward's a
  float least = 0, most = 0;  ///< spacing of records, pixels
  int rays = 0;               ///< of a record
};

/// How light is estimated from them.
struct TwoPassSettings {
  EstimateSettings global, caustic;
  int gather_rays = 1;
  float shortest = 0;  ///< gather rays below this, m, do not read the map where they end
  std::optional<GatherCacheSettings> cache;
  Show show = Show::image;
};

/// What all vertices of a pixel's eye path and of its gather rays need besides the PathContext.
struct TwoPassContext {
  const RenderJob& job;
  const TwoPassSettings& settings;
  const TwoPassMaps& maps;
  std::uint32_t pixel_key, pass;
  std::atomic<std::uint64_t>* misses =
      nullptr;                        ///< counts final gathers that find nothing in the cache, if there is one
  ReversePhotons* reverse = nullptr;  ///< where the global map would be read is kept here, for photons that come later
};

/// The pass's cache of irradiance for this vertex, where it has one: for diffuse surfaces, but hairs, whose normals are
/// the rays'. Eye paths of other depths have other light, as the depth limit counts whole paths.
inline const IrradianceCache* cache_for(const TwoPassMaps& maps, const SurfaceVertex& vertex) {
  const Spectrum* reflectance = lambertian_reflectance(vertex.at.bsdf);
  if (reflectance == nullptr || reflectance->is_black() || vertex.at.is_hair || vertex.state.non_delta > 0 ||
      vertex.state.dispersed || static_cast<std::size_t>(vertex.state.depth) > maps.gathered.size())
    return nullptr;
  return &maps.gathered[static_cast<std::size_t>(vertex.state.depth - 1)];
}
/// The shading normal on the side of the eye.
inline Normal normal_of_light(const SurfaceVertex& vertex) {
  return vertex.wi_local.z < 0 ? -vertex.at.shading.n : vertex.at.shading.n;
}

/// What is left to the eye path of a vertex whose wide lobes' share p is estimated there: it goes on, but is not
/// followed every time if that is little.
inline Continuation narrow_lobes(float share) { return {std::fmin(1.0f, 4 * (1 - share)), 1 - share}; }

/// Follows the eye path of a pixel, and the rays of its final gathers.
class TwoPassVisitor : PathVisitor {
 public:
  TwoPassVisitor(const PathVisitor& base, const TwoPassContext& context) : PathVisitor(base), context_(context) {}
  /// A gather ray: it leaves a vertex whose direct light and caustics are known.
  static TwoPassVisitor of_gather_ray(const PathVisitor& base, const TwoPassContext& context, int non_delta) {
    TwoPassVisitor visitor(base, context);
    visitor.is_gather_ray_ = true;
    visitor.known_ = non_delta;
    return visitor;
  }

  Continuation operator()(const SurfaceVertex& vertex);
  Continuation operator()(const MediumVertex& vertex) {
    begin(vertex.state.depth == 1 ? Term::direct : Term::specular);
    return PathVisitor::operator()(vertex);
  }
  void operator()(const EmissionVertex& vertex) {
    begin(term_of_hit(vertex.state, vertex.state.depth));
    PathVisitor::operator()(vertex);
  }
  void operator()(const EscapeVertex& vertex) {
    begin(term_of_hit(vertex.state, vertex.state.depth));
    if (!is_known(vertex.state)) PathVisitor::operator()(vertex);
  }

 private:
  // Light that the walk would find here has been estimated where it last scattered by more than a delta lobe.
  bool is_known(const WalkState& state) const { return known_ > 0 && state.non_delta == known_; }
  static Term term_of_hit(const WalkState& state, int scatterings) {
    return scatterings == 1 && !state.last_delta ? Term::direct : Term::specular;
  }
  void begin(Term term) {
    if (!is_gather_ray_) layers.begin_part(static_cast<std::size_t>(term));
  }

  void next_events(const SurfaceVertex& vertex, float walk_probability, int count);
  DirectLight direct_light(const PathContext& sample, const SurfaceVertex& vertex, float walk_probability) const;
  void show(const SurfaceVertex& vertex);
  Continuation estimate_by_terms(const SurfaceVertex& vertex);
  Continuation read_map(const SurfaceVertex& vertex);
  std::optional<Spectrum> precomputed(const SurfaceVertex& vertex) const;
  Continuation continue_short_ray(const SurfaceVertex& vertex);
  void add_caustics(const SurfaceVertex& vertex, float share);
  void gather(const SurfaceVertex& vertex, float share);
  void show_records(const SurfaceVertex& vertex);
  void show_shadows(const SurfaceVertex& vertex);
  Sampler branch(const SurfaceVertex& vertex, int number, int rays) const;

  const TwoPassContext& context_;
  bool is_gather_ray_ = false;
  int known_ = 0;  // non-delta scatterings of a walk that may not find light by itself
};

}  // namespace lanthorn
