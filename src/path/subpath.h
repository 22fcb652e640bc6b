// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Densities along the two kinds of subpath that bidirectional methods join.
#pragma once

#include <cmath>
#include <variant>
#include <vector>

#include "path/mis.h"
#include "path/vertex.h"
#include "scene/scene.h"

namespace lanthorn {

/// Probability with which a light path begins on each light: in proportion to power, as PhotonAllocation shares them.
std::vector<float> emission_probabilities(const Scene& scene);

/// Photons are stored and found at all surfaces that scatter, but on hair, where an area says nothing, and mirrors.
inline bool merges_at(const SurfacePoint& at) {
  return has_non_delta(at.bsdf) && !std::holds_alternative<Hair>(at.bsdf);
}

/// Density, per solid angle at `from`, with which next-event estimation chooses `direction` towards the point of the
/// light at `hit`; of lights without extent the probability of the light alone. For weights: area lights' own density
/// is known to them, all others are asked by direction.
float next_event_density(const Scene& scene, std::uint32_t light, const Point& from, const Normal& normal,
                         const EmitterHit& hit, const Direction& direction);

/// Follows the walk of a subpath and keeps its densities. `begin` first; then `arrive` at each vertex, in order.
class Subpath {
 public:
  explicit Subpath(const Techniques& techniques) : techniques_(techniques) {}

  /// An eye path.
  void begin_at_lens() { at_lens_ = true; }
  /// A light path from light `index`, chosen with `probability`.
  void begin_at_light(std::uint32_t index, const EmissionSample& emission, float probability) {
    light_ = index;
    emission_ = emission;
    probability_ = probability;
  }

  /// Densities at the vertex.
  const SubpathDensities& arrive(const Scene& scene, const SurfaceVertex& v);
  const SubpathDensities& arrive(const Scene& scene, const MediumVertex& v);
  /// Densities on the way out of the scene.
  const SubpathDensities& escape(const EscapeVertex& v);

 private:
  void begin(const Scene& scene, const WalkState& state, const Point& position, const Normal& normal, float time);
  void leave_previous(const WalkState& state, const Direction& direction);

  // Where the walk was last.
  struct Previous {
    bool is_surface = false, merges = false;
    Bsdf bsdf;
    Frame shading;
    Normal normal{0};
    Vec3 wi_local{0};
  };

  Techniques techniques_;
  SubpathDensities densities_;
  Previous previous_;
  bool at_lens_ = false, comes_from_infinity_ = false;
  std::uint32_t light_ = 0;
  EmissionSample emission_;
  float probability_ = 0;
};

}  // namespace lanthorn
