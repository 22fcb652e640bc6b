// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The second pass of photon mapping (Jensen 1996; 2001, chapter 9). Light at a surface is the sum of four terms: A,
// direct light by next-event estimation; B, light reflected by mirrors, glass and narrow lobes, by continuing the eye
// path; C, caustics, from the caustic map; D, other indirect light by final gathering: rays at whose ends the global
// map is read.
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
#include "photon/gather/radiance_estimate.h"
#include "photon/guides/guide_photons.h"
#include "photon/media/volume_walk.h"
#include "photon/photon_map.h"

namespace lanthorn {

/// The photons of a pass.
struct TwoPassMaps {
  using Map = PhotonMap<BucketKdTree>;

  PassDraw draw;
  Map global;  ///< all photons
  Map caustic;
  std::optional<IrradiancePhotons> irradiance;  ///< of the global map
  std::optional<GuidePhotons> guides;           ///< of the light that final gathering has to find
  /// Irradiance caches of final gathering, indexed by depth of the eye path's vertex - 1; none if every vertex gathers.
  std::vector<IrradianceCache> gathered;
  std::optional<ShadowPhotons> shadows;  ///< if they replace shadow rays
  std::optional<VolumeGather> volume;    ///< if there are photons in media
  PassReport report;
};

/// The quantity to show: the picture, or the contents of a map where it is looked up.
enum class Show : std::uint8_t { image, global, caustic, shadow, radius, density, records };

/// Settings of the irradiance cache.
struct GatherCacheSettings {
  float error = 0;            ///< Ward's a
  float least = 0, most = 0;  ///< spacing of records, pixels
  int rays = 0;               ///< of a record
};

/// Settings of the second pass.
struct TwoPassSettings {
  EstimateSettings global, caustic;
  int gather_rays = 1;
  float shortest = 0;  ///< gather rays shorter than this, m, do not read the map at their end
  std::optional<GatherCacheSettings> cache;
  Show show = Show::image;
};

/// State shared by all vertices of a pixel's eye path and of its gather rays, besides the PathContext.
struct TwoPassContext {
  const RenderJob& job;
  const TwoPassSettings& settings;
  const TwoPassMaps& maps;
  std::uint32_t pixel_key, pass;
  std::atomic<std::uint64_t>* misses = nullptr;  ///< counts final gathers without a valid record, if there is a cache
  ReversePhotons* reverse = nullptr;             ///< if set, receives the points at which the global map would be read
};

/// The pass's irradiance cache for this vertex, null if there is none. Only diffuse surfaces have one; hairs have none,
/// because their normals depend on the ray. Each depth has its own cache, because the depth limit counts whole paths.
inline const IrradianceCache* cache_for(const TwoPassMaps& maps, const SurfaceVertex& vertex) {
  const Spectrum* reflectance = lambertian_reflectance(vertex.at.bsdf);
  if (reflectance == nullptr || reflectance->is_black() || vertex.at.is_hair || vertex.state.non_delta > 0 ||
      vertex.state.dispersed || static_cast<std::size_t>(vertex.state.scatterings()) > maps.gathered.size())
    return nullptr;
  return &maps.gathered[static_cast<std::size_t>(vertex.state.scatterings() - 1)];
}
/// The shading normal on the side of the surface that the eye sees.
inline Normal normal_of_light(const SurfaceVertex& vertex) {
  return dot(vertex.wi, vertex.at.normal) < 0 ? -vertex.at.shading.n : vertex.at.shading.n;
}

/// Continuation of the eye path at a vertex where many gather rays estimate the light of wide lobes. The walk's part of
/// the light is sampled with four times its usual probability, so that its noise matches that of the many rays.
/// Branches find infinite lights, one branch for each sample of direct light.
inline NarrowContinuation narrow_lobes(const LobeSplit& split) { return NarrowContinuation::with_sky_branch(split, 4); }

/// Follows the eye path of a pixel, and the rays of its final gathers.
class TwoPassVisitor : PathVisitor {
 public:
  TwoPassVisitor(const PathVisitor& base, const TwoPassContext& context) : PathVisitor(base), context_(context) {
    if (context.maps.volume) volume_.emplace(*context.maps.volume);
  }
  /// A gather ray: it leaves a vertex whose direct light and caustics are known.
  static TwoPassVisitor of_gather_ray(const PathVisitor& base, const TwoPassContext& context, int non_delta) {
    TwoPassVisitor visitor(base, context);
    visitor.is_gather_ray_ = true;
    visitor.known_ = non_delta;
    return visitor;
  }

  NarrowContinuation operator()(const SurfaceVertex& vertex);
  Continuation operator()(const MediumVertex& vertex);
  void operator()(const FlownSegment& flight) {
    if (!volume_) return;
    layers.see(flight);
    add_photons(flight.state, flight.state.depth == 0, volume_->along(path, flight));
  }
  void operator()(const MediumRay& ray) {
    begin(ray.state.depth == 0 ? Term::direct : Term::specular);
    PathVisitor::operator()(ray);
  }
  void operator()(const EmissionVertex& vertex) {
    begin(term_of_hit(vertex.state, vertex.state.depth));
    if (adds_hits(vertex.state) || !path.scene.volume_light(vertex.state.medium)) PathVisitor::operator()(vertex);
  }
  void operator()(const EscapeVertex& vertex) {
    begin(term_of_hit(vertex.state, vertex.state.depth));
    if (adds_hits(vertex.state)) PathVisitor::operator()(vertex);
  }

 private:
  // Light found here has already been estimated at the last non-delta scattering.
  bool is_known(const WalkState& state) const { return known_ > 0 && state.non_delta == known_; }
  bool adds_hits(const WalkState& state) const { return !is_known(state) && (!volume_ || volume_->finds_hits()); }
  static Term term_of_hit(const WalkState& state, int scatterings) {
    return scatterings == 1 && !state.last_delta ? Term::direct : Term::specular;
  }
  void begin(Term term) {
    if (!is_gather_ray_) layers.begin_part(static_cast<std::size_t>(term));
  }

  void add_photons(const WalkState& state, bool is_first, const GatheredLight& light);
  void next_events(const SurfaceVertex& vertex, const NarrowContinuation& answer, int count);
  DirectLight direct_light(const PathContext& sample, const SurfaceVertex& vertex,
                           const NarrowContinuation& answer) const;
  void show(const SurfaceVertex& vertex);
  NarrowContinuation estimate_by_terms(const SurfaceVertex& vertex);
  NarrowContinuation read_map(const SurfaceVertex& vertex);
  void add_photons(const SurfaceVertex& vertex, const LobeSplit& split);
  std::optional<Spectrum> precomputed(const SurfaceVertex& vertex) const;
  NarrowContinuation continue_short_ray(const SurfaceVertex& vertex);
  void add_caustics(const SurfaceVertex& vertex, const LobeSplit& split);
  void gather(const SurfaceVertex& vertex, const LobeSplit& split);
  void show_records(const SurfaceVertex& vertex);
  void show_shadows(const SurfaceVertex& vertex);
  Sampler branch(const SurfaceVertex& vertex, int number, int rays) const;

  const TwoPassContext& context_;
  bool is_gather_ray_ = false;
  std::optional<VolumeWalk> volume_;
  int known_ = 0;  // non-delta scatterings at which the walk must not add light
};

/// The second pass of reverse photon mapping (Havran, Herzog & Seidel 2005): eye paths are traced first and their ends
/// are stored as reverse photons; then each photon adds its light to the reverse photons within its radius
/// (reverse_gather.cpp). Adds the pass to the film, in blocks of pixels whose reverse photons fit into about the
/// `memory` bytes of the settings.
PassReport gather_in_reverse(const RenderJob& job, const TwoPassSettings& settings, const TwoPassMaps& maps,
                             RadiusRule radii, std::uint32_t pass, const FilmPass& film, const PhaseObserver& begin);

}  // namespace lanthorn
