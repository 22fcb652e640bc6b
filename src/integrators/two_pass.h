// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The second of photon mapping's two passes (Jensen 1996; 2001, chapter 9). Light at a surface is the sum of four
// terms: A, direct light by next-event estimation; B, what mirrors, glass and narrow lobes bring, by going on with the
// eye path; C, caustics, from a map of their own; D, all other indirect light, by final gathering: rays whose ends read
// the global map.
#pragma once

#include <cstdint>
#include <optional>

#include "cache/bucket_kdtree.h"
#include "cache/guide_photons.h"
#include "cache/irradiance_photons.h"
#include "cache/photon_map.h"
#include "cache/radiance_estimate.h"
#include "cache/reverse_photons.h"
#include "integrators/integrator.h"
#include "path/path_draw.h"
#include "path/path_visitor.h"

namespace lanthorn {

/// The photons of a pass.
struct TwoPassMaps {
  using Map = PhotonMap<BucketKdTree>;

  PathDraw draw;
  Map global;  ///< all photons
  Map caustic;
  std::optional<IrradiancePhotons> irradiance;  ///< of the global map
  std::optional<GuidePhotons> guides;           ///< of the light that final gathering looks for
  PassReport report;
};

/// Instead of the picture, what the maps hold where it is looked up.
enum class Show : std::uint8_t { image, global, caustic, radius, density };

/// How light is estimated from them.
struct TwoPassSettings {
  EstimateSettings global, caustic;
  int gather_rays = 1;
  float shortest = 0;  ///< gather rays below this, m, do not read the map where they end
  Show show = Show::image;
};

/// What all vertices of a pixel's eye path and of its gather rays need.
struct TwoPassContext {
  const Scene& scene;
  const RenderSettings& render;
  const TwoPassSettings& settings;
  const TwoPassMaps& maps;
  std::uint32_t pixel_key, pass;
  RayCounts& counts;
  LightLayers& layers;
  ReversePhotons* reverse = nullptr;  ///< where the global map would be read is kept here, for photons that come later
};

/// Follows the eye path of a pixel, and the rays of its final gathers.
class TwoPassVisitor : PathVisitor {
 public:
  TwoPassVisitor(const TwoPassContext& context, Sampler& numbers)
      : PathVisitor{context.scene, context.maps.draw.w, numbers, context.counts, context.layers}, context_(context) {}
  /// A gather ray: it leaves a vertex whose direct light and caustics are known.
  static TwoPassVisitor of_gather_ray(const TwoPassContext& context, Sampler& numbers, int non_delta) {
    TwoPassVisitor visitor(context, numbers);
    visitor.is_gather_ray_ = true;
    visitor.known_ = non_delta;
    return visitor;
  }

  Continuation operator()(const SurfaceVertex& vertex);
  Continuation operator()(const MediumVertex& vertex) {
    begin(vertex.state.depth == 1 ? Term::direct : Term::specular);
    return PathVisitor::operator()(vertex);
  }
  void operator()(const GlowVertex& vertex) {
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
    if (!is_gather_ray_) layers.begin(term);
  }

  void next_events(const SurfaceVertex& vertex, float walk_probability, int count);
  void show(const SurfaceVertex& vertex);
  Continuation estimate_by_terms(const SurfaceVertex& vertex);
  Continuation read_map(const SurfaceVertex& vertex);
  std::optional<Spectrum> precomputed(const SurfaceVertex& vertex) const;
  Continuation continue_short_ray(const SurfaceVertex& vertex);
  void add_caustics(const SurfaceVertex& vertex, float share);
  void gather(const SurfaceVertex& vertex, float share);
  Sampler branch(const SurfaceVertex& vertex, int number) const;

  const TwoPassContext& context_;
  bool is_gather_ray_ = false;
  int known_ = 0;  // non-delta scatterings of a walk that may not find light by itself
};

}  // namespace lanthorn
