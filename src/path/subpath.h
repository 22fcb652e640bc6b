// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Densities along the eye subpaths and light subpaths of bidirectional methods.
#pragma once

#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include "camera/camera.h"
#include "path/mis.h"
#include "path/path_weights.h"
#include "path/vertex.h"
#include "scene/scene.h"

namespace lanthorn {

/// Probability with which a light path begins on each light: proportional to power, as in PhotonAllocation.
std::vector<float> emission_probabilities(const Scene& scene);

/// True where photons are stored and merged: at surfaces with a non-delta lobe, except fibres. The photons on a fibre
/// do not lie in a disc, so that no area can be given.
inline bool merges_at(const SurfacePoint& at) { return has_non_delta(at.bsdf) && !is_fibre(at.bsdf); }

/// Density, per solid angle at `from`, with which next-event estimation chooses `direction` towards the point `hit` of
/// the light. For point, spot and distant lights it is the probability of choosing the light. Used by MIS weights.
float next_event_density(const Scene& scene, std::uint32_t light, const Point& from, const Normal& normal,
                         const EmitterHit& hit, const Direction& direction);

/// Records the densities of a subpath during its walk. Call a `begin` function first, then `arrive` at each vertex in
/// order.
class Subpath {
 public:
  /// `trails` receives the vertices, after those of other subpaths, if the techniques' weights need them.
  explicit Subpath(const Techniques& techniques, std::vector<TrailVertex>* trails = nullptr)
      : techniques_(techniques), trails_(techniques.correlated() ? trails : nullptr) {
    if (trails_) trail_begin_ = trails_->size();
  }

  /// Begins an eye path.
  void begin_at_lens(const Camera& camera) { camera_ = &camera; }
  /// Begins a light path from light `index`, which was chosen with `probability`.
  void begin_at_light(std::uint32_t index, const EmissionSample& emission, float probability) {
    light_ = index;
    emission_ = emission;
    probability_ = probability;
  }

  void arrive(const Scene& scene, const SurfaceVertex& v);
  void arrive(const Scene& scene, const MediumVertex& v);
  /// The walk leaves the last vertex, and the scene: densities are then those of light that comes along the ray.
  void escape(const WalkState& state, const Direction& direction);

  /// Densities at the last vertex.
  const SubpathDensities& densities() const { return densities_; }
  /// All vertices, including the point on the light. Empty if trails are not kept.
  std::span<const TrailVertex> trail() const {
    return trails_ ? std::span<const TrailVertex>(*trails_).subspan(trail_begin_) : std::span<const TrailVertex>();
  }
  std::size_t trail_begin() const { return trail_begin_; }
  /// Distance from the lens to the first vertex of an eye path.
  float first_distance() const { return first_distance_; }
  /// How the walk left a vertex: density per solid angle (1 for delta lobes), and |cos| there (1 in media).
  struct Step {
    float pdf = 0, cos = 1;
  };
  const Step& last_step() const { return step_; }

 private:
  struct Position {
    Point position;
    Normal normal{0};  // 0 in a medium
    float time = 0;
    float cos = 1;  // |cos| of the walk's incident direction
    bool merges = false;
  };
  void arrive_at(const Scene& scene, const WalkState& state, const Position& at, const Direction& wi);
  void begin(const Scene& scene, const WalkState& state, const Position& at, float distance2);
  void leave_previous(const WalkState& state, const Direction& direction);

  // The previous vertex.
  struct Previous {
    std::optional<SurfacePoint> surface;  // empty in a medium
    Vec3 wi_local{0};
    bool merges = false;
  };

  Techniques techniques_;
  std::vector<TrailVertex>* trails_;
  std::size_t trail_begin_ = 0;
  SubpathDensities densities_;
  Previous previous_;
  Step step_;
  float first_distance_ = 0;
  const Camera* camera_ = nullptr;  // of eye paths
  bool comes_as_ray_ = false;
  std::uint32_t light_ = 0;
  EmissionSample emission_;
  float probability_ = 0;
};

}  // namespace lanthorn
